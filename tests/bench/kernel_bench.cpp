// The O(n^2) part of an update alone: P -= W W^T on the lower triangle, 20 columns (ten sightings).

#include <random>
#include <support/random_matrix.hpp>

#include <Eigen/Dense>
#include <benchmark/benchmark.h>

#include <libslam/state/symmetric_kernel.hpp>

namespace {

using namespace libslam;

constexpr Eigen::Index kRows = 20;

[[maybe_unused]] const bool kDescribed = [] {
  benchmark::AddCustomContext("vectors", symmetric_kernels().front().name);
  return true;
}();

struct Operands {
  explicit Operands(Eigen::Index dimension) : n(dimension) {
    const Eigen::Index padded = (n + kKernelTile - 1) / kKernelTile * kKernelTile;
    std::mt19937_64 random(81);
    p = Eigen::MatrixXd::Identity(padded, padded);
    w = Eigen::MatrixXd::Zero(padded, kRows);
    // Small enough that P stays in the range of normal numbers over all repetitions.
    w.topRows(n) = 1e-8 * libslam::testing::random_matrix(n, kRows, random);
  }
  Eigen::Index n;
  Eigen::MatrixXd p, w;
};

void kernel_libslam(benchmark::State& state) {
  Operands x(state.range(0));
  const SymmetricUpdate update{x.p.data(), x.p.rows(), x.n,  x.w.data(),
                               x.w.data(), x.w.rows(), kRows};
  for (auto _ : state) {
    symmetric_kernels().front().subtract(update);
    benchmark::ClobberMemory();
  }
  state.counters["steps"] = 1;
}

void kernel_eigen(benchmark::State& state) {
  Operands x(state.range(0));
  for (auto _ : state) {
    x.p.topLeftCorner(x.n, x.n).selfadjointView<Eigen::Lower>().rankUpdate(x.w.topRows(x.n), -1.0);
    benchmark::ClobberMemory();
  }
  state.counters["steps"] = 1;
}

void state_sizes(benchmark::internal::Benchmark* family) {
  for (const int landmarks : {25, 50, 100, 200, 400, 800, 1600}) family->Arg(2 * landmarks + 3);
  family->Unit(benchmark::kMillisecond);
}

BENCHMARK(kernel_libslam)->Name("kernel/libslam")->Apply(state_sizes);
BENCHMARK(kernel_eigen)->Name("kernel/eigen")->Apply(state_sizes);

}  // namespace
