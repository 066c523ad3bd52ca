#include <algorithm>
#include <cstring>

#include <libslam/state/symmetric_kernel.hpp>

namespace libslam {

namespace {

constexpr std::ptrdiff_t kColumns = 4;
constexpr std::ptrdiff_t kLanes = 8;

using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
static_assert(kKernelTile == 2 * kLanes);

}  // namespace

// ThreadSanitizer instruments the resolver that target_clones generates, which runs before it is
// ready.
#if defined(__SANITIZE_THREAD__)
#define LIBSLAM_WIDEST_VECTORS
#else
#define LIBSLAM_WIDEST_VECTORS \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#endif

// A tile of 16 rows and 4 columns is accumulated in registers (8 AVX-512 or 16 AVX2 accumulators)
// over all m columns of W, then subtracted once: P is read and written exactly once.
LIBSLAM_WIDEST_VECTORS void subtract_outer_product(double* p, std::ptrdiff_t p_stride,
                                                   std::ptrdiff_t n, const double* w,
                                                   std::ptrdiff_t w_stride, std::ptrdiff_t m) {
  for (std::ptrdiff_t j0 = 0; j0 < n; j0 += kColumns) {
    for (std::ptrdiff_t i0 = j0 - j0 % kKernelTile; i0 < n; i0 += kKernelTile) {
      Lanes low[kColumns] = {}, high[kColumns] = {};
      for (std::ptrdiff_t k = 0; k < m; ++k) {
        const double* column = w + k * w_stride;
        Lanes a, b;
        std::memcpy(&a, column + i0, sizeof(a));
        std::memcpy(&b, column + i0 + kLanes, sizeof(b));
        for (std::ptrdiff_t c = 0; c < kColumns; ++c) {
          const double factor = column[j0 + c];
          low[c] += a * factor;
          high[c] += b * factor;
        }
      }
      for (std::ptrdiff_t c = 0; c < kColumns && j0 + c < n; ++c) {
        double* target = p + (j0 + c) * p_stride + i0;
        if (i0 >= j0 + c && i0 + kKernelTile <= n) {
          Lanes a, b;
          std::memcpy(&a, target, sizeof(a));
          std::memcpy(&b, target + kLanes, sizeof(b));
          a -= low[c];
          b -= high[c];
          std::memcpy(target, &a, sizeof(a));
          std::memcpy(target + kLanes, &b, sizeof(b));
        } else {
          double tile[kKernelTile];
          std::memcpy(tile, &low[c], sizeof(Lanes));
          std::memcpy(tile + kLanes, &high[c], sizeof(Lanes));
          const std::ptrdiff_t first = std::max<std::ptrdiff_t>(0, j0 + c - i0);
          const std::ptrdiff_t last = std::min(kKernelTile, n - i0);
          for (std::ptrdiff_t r = first; r < last; ++r) target[r] -= tile[r];
        }
      }
    }
  }
}

}  // namespace libslam
