// What the adaptation of R costs: two filters on the same steps, in turns, so that whatever else
// the machine does meets both alike. Where the allocator puts their covariances decides on several
// per cent, hence many pairs of filters, built in either order. The median over all updates is
// reported, and the difference as a share of the update without adaptation; `control` compares two
// filters without adaptation, which shows how far from zero nothing is.

#include <algorithm>
#include <array>
#include <bench/ring_world.hpp>
#include <chrono>
#include <vector>

#include <benchmark/benchmark.h>

#include <libslam/filter/ekf_slam.hpp>
#include <libslam/pipeline/factory.hpp>

namespace {

using namespace libslam;
using bench::RingStep;

EkfSlamParts parts(const char* adaptation) {
  Parameters parameters;
  parameters.filter.error_frame = "right_invariant";
  parameters.association.gate_probability = 1.0;
  parameters.policies.noise_adaptation.method = adaptation;
  return make_filter_parts(parameters);
}

/// Moves `filter` and returns how long its update takes [us].
double timed_update(EkfSlam& filter, const RingStep& step) {
  using Clock = std::chrono::steady_clock;
  filter.propagate(&step.action);
  const Clock::time_point start = Clock::now();
  benchmark::DoNotOptimize(filter.update(step.features));
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

using Times = std::array<std::vector<double>, 2>;  // without and with

/// The first lap, in which the map grows, is not timed.
void time_pair(const std::vector<RingStep>& lap, const char* adaptation, bool swapped,
               Times& times) {
  constexpr std::size_t kSteps = 200;
  const std::size_t first = swapped ? 1 : 0;
  const std::array<const char*, 2> methods = {"off", adaptation};
  std::vector<EkfSlam> filters;  // the first is that of methods[first]
  filters.reserve(2);
  for (const std::size_t which : {first, 1 - first}) {
    EkfSlam& filter = filters.emplace_back(parts(methods[which]));
    for (const RingStep& step : lap) {
      if (&step != &lap.front()) filter.propagate(&step.action);
      filter.update(step.features);
    }
  }
  for (std::size_t k = 0; k < kSteps; ++k)
    for (const std::size_t which : {k % 2, 1 - k % 2})  // neither always finds the data cached
      times[which].push_back(timed_update(filters[which ^ first], lap[k % lap.size()]));
}

void adaptation_cost(benchmark::State& state, const char* adaptation) {
  const std::vector<RingStep>& lap = bench::ring_world(static_cast<int>(state.range(0))).lap;
  Times times;
  bool swapped = false;
  for (auto _ : state) {
    time_pair(lap, adaptation, swapped, times);
    swapped = !swapped;
  }
  const double fixed = median(times[0]), adaptive = median(times[1]);
  state.counters["steps"] = 1;
  state.counters["fixed_us"] = fixed;
  state.counters["cost_us"] = adaptive - fixed;
  state.counters["cost_percent"] = 100.0 * (adaptive - fixed) / fixed;
}

void sizes(benchmark::internal::Benchmark* family) {
  constexpr int kPairs = 40;
  for (const int landmarks : {25, 100, 400}) family->Arg(landmarks);
  family->Iterations(kPairs)->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(adaptation_cost, residual, "residual")->Name("adaptation/residual")->Apply(sizes);
BENCHMARK_CAPTURE(adaptation_cost, control, "off")->Name("adaptation/control")->Apply(sizes);

}  // namespace
