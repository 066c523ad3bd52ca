#pragma once
// The one O(n^2) kernel of the dense filter: a symmetric rank-m update of the lower triangle.

#include <cstddef>

namespace libslam {

/// Rows of `w` are padded with zeros to a multiple of this; the kernel reads whole tiles.
inline constexpr std::ptrdiff_t kKernelTile = 16;

/// P(i, j) -= sum_k W(i, k) W(j, k) for i >= j. `p`: n x n column-major with stride `p_stride`,
/// only the lower triangle is read and written. `w`: at least ceil16(n) x m, column-major with
/// stride `w_stride`, rows from n on are zero. Vector width is chosen at run time; results on one
/// machine are reproducible bit for bit.
void subtract_outer_product(double* p, std::ptrdiff_t p_stride, std::ptrdiff_t n, const double* w,
                            std::ptrdiff_t w_stride, std::ptrdiff_t m);

}  // namespace libslam
