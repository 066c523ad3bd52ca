#include <cstdint>
#include <cstring>
#include <vector>

#include <libslam/state/symmetric_kernel.hpp>

#define LIBSLAM_INLINE inline __attribute__((always_inline))

namespace libslam {

namespace {

using std::ptrdiff_t;

constexpr ptrdiff_t kColumns = 4;

template <int kLanes>
struct Vector;
template <>
struct Vector<2> {
  using Numbers = double __attribute__((vector_size(16)));
  using Mask = std::int64_t __attribute__((vector_size(16)));
};
template <>
struct Vector<4> {
  using Numbers = double __attribute__((vector_size(32)));
  using Mask = std::int64_t __attribute__((vector_size(32)));
};
template <>
struct Vector<8> {
  using Numbers = double __attribute__((vector_size(64)));
  using Mask = std::int64_t __attribute__((vector_size(64)));
};

/// The loops for vectors of `kLanes` numbers. It must be what the machine has: the compiler takes
/// wider vectors apart through memory, 40 times slower than vectors that fit.
template <int kLanes>
struct Loops {
  using Numbers = typename Vector<kLanes>::Numbers;
  using Mask = typename Vector<kLanes>::Mask;
  static constexpr ptrdiff_t kRows = 2 * kLanes;
  static_assert(kKernelTile % kRows == 0 && kKernelTile % kColumns == 0);
  // A diagonal tile must cover all its columns.
  static_assert(kRows % kColumns == 0);

  struct Rows {
    Numbers low = {}, high = {};

    static LIBSLAM_INLINE Rows load(const double* from) {
      Rows rows;
      std::memcpy(&rows.low, from, sizeof(Numbers));
      std::memcpy(&rows.high, from + kLanes, sizeof(Numbers));
      return rows;
    }
    LIBSLAM_INLINE void store(double* to) const {
      std::memcpy(to, &low, sizeof(Numbers));
      std::memcpy(to + kLanes, &high, sizeof(Numbers));
    }
    LIBSLAM_INLINE void add(const Rows& other, double factor) {
      low += other.low * factor;
      high += other.high * factor;
    }
    LIBSLAM_INLINE void clear_before(std::int64_t first) {
      Mask index = {};
      for (int i = 0; i < kLanes; ++i) index[i] = i;
      low = reinterpret_cast<Numbers>(reinterpret_cast<Mask>(low) & (index >= first));
      high = reinterpret_cast<Numbers>(reinterpret_cast<Mask>(high) & (index >= first - kLanes));
    }
  };

  /// The factors' m columns leave the hardware's prefetcher no stream for P; without this an update
  /// of a P that is larger than the caches takes twice as long.
  static LIBSLAM_INLINE void prefetch(const double* tile, ptrdiff_t stride) {
    for (ptrdiff_t c = 0; c < kColumns; ++c) {
      const double* ahead = tile + c * stride + 2 * kKernelTile;
      __builtin_prefetch(ahead, 1);
      __builtin_prefetch(ahead + kLanes, 1);
    }
  }

  /// A tile of two vectors by 4 columns is accumulated in registers over all m columns of the
  /// factors, then subtracted once: P is read and written exactly once.
  static LIBSLAM_INLINE void subtract(const SymmetricUpdate& x) {
    for (ptrdiff_t j0 = 0; j0 < x.n; j0 += kColumns) {
      const ptrdiff_t diagonal = j0 - j0 % kRows;
      for (ptrdiff_t i0 = diagonal; i0 < x.n; i0 += kRows) {
        double* tile = x.p + j0 * x.p_stride + i0;
        prefetch(tile, x.p_stride);
        Rows sum[kColumns];
        for (ptrdiff_t k = 0; k < x.m; ++k) {
          const Rows a = Rows::load(x.a + k * x.stride + i0);
          const double* factors = x.b + k * x.stride + j0;
          for (ptrdiff_t c = 0; c < kColumns; ++c) sum[c].add(a, factors[c]);
        }
        for (ptrdiff_t c = 0; c < kColumns; ++c) {
          if (i0 == diagonal) sum[c].clear_before(j0 + c - i0);
          Rows p = Rows::load(tile + c * x.p_stride);
          p.add(sum[c], -1.0);
          p.store(tile + c * x.p_stride);
        }
      }
    }
  }

  /// Forward substitution for a few rows at a time, which stay in the nearest cache.
  static LIBSLAM_INLINE void divide(const TransposedDivision& x) {
    for (ptrdiff_t i0 = 0; i0 < x.n; i0 += kRows)
      for (ptrdiff_t k = 0; k < x.m; ++k) {
        double* target = x.w + k * x.w_stride + i0;
        Rows rest = Rows::load(target);
        for (ptrdiff_t l = 0; l < k; ++l)
          rest.add(Rows::load(x.w + l * x.w_stride + i0), -x.lower[l * x.lower_stride + k]);
        Rows solved;
        solved.add(rest, 1.0 / x.lower[k * x.lower_stride + k]);
        solved.store(target);
      }
  }
};

void subtract_baseline(const SymmetricUpdate& x) {
  Loops<2>::subtract(x);
}
void divide_baseline(const TransposedDivision& x) {
  Loops<2>::divide(x);
}

#if defined(__x86_64__)
#define LIBSLAM_AVX2 __attribute__((target("avx2,fma")))
#define LIBSLAM_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,fma")))
LIBSLAM_AVX2 void subtract_avx2(const SymmetricUpdate& x) {
  Loops<4>::subtract(x);
}
LIBSLAM_AVX2 void divide_avx2(const TransposedDivision& x) {
  Loops<4>::divide(x);
}
LIBSLAM_AVX512 void subtract_avx512(const SymmetricUpdate& x) {
  Loops<8>::subtract(x);
}
LIBSLAM_AVX512 void divide_avx512(const TransposedDivision& x) {
  Loops<8>::divide(x);
}
#endif

std::vector<SymmetricKernels> supported_kernels() {
  std::vector<SymmetricKernels> kernels;
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    kernels.push_back({"avx512", subtract_avx512, divide_avx512});
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    kernels.push_back({"avx2", subtract_avx2, divide_avx2});
#endif
  kernels.push_back({"baseline", subtract_baseline, divide_baseline});
  return kernels;
}

}  // namespace

std::span<const SymmetricKernels> symmetric_kernels() {
  static const std::vector<SymmetricKernels> kernels = supported_kernels();
  return kernels;
}

}  // namespace libslam
