#pragma once
// The loops of the dense filter that cost O(n^2 m) and O(n m^2), for every vector width.

#include <cstddef>
#include <span>

namespace libslam {

/// Matrices are column-major and padded to a multiple of this in both dimensions; the kernels read
/// and write whole tiles. Rows of padding are zero in the factors and without meaning in P.
inline constexpr std::ptrdiff_t kKernelTile = 16;

/// P(i, j) -= sum_k A(i, k) B(j, k) for i >= j, where A B^T is symmetric. What lies above the
/// diagonal of P keeps its value.
struct SymmetricUpdate {
  double* p;                   ///< padded n x padded n
  std::ptrdiff_t p_stride, n;  ///< distance of columns; dimension of P
  const double *a, *b;         ///< padded n x m; may be the same
  std::ptrdiff_t stride, m;    ///< distance of their columns; number of their columns
};

/// W <- W L^-T.
struct TransposedDivision {
  double* w;                       ///< padded n x m
  std::ptrdiff_t w_stride, n;      ///< distance of columns; rows of W
  const double* lower;             ///< L, m x m; nothing above its diagonal is read
  std::ptrdiff_t lower_stride, m;  ///< distance of columns; dimension of L
};

struct SymmetricKernels {
  const char* name;  ///< "avx512", "avx2" or "baseline"
  void (*subtract)(const SymmetricUpdate&);
  void (*divide)(const TransposedDivision&);
};

/// What this machine can run, the fastest first; never empty. Results differ in rounding between
/// kernels; those of one kernel are reproducible bit for bit.
std::span<const SymmetricKernels> symmetric_kernels();

}  // namespace libslam
