// One step with ten sightings in a complete map, against the number of landmarks: libslam in both
// error frames and both methods of MRPT, all with the same data.

#include <bench/mrpt_filter.hpp>
#include <bench/ring_world.hpp>
#include <optional>
#include <string>

#include <benchmark/benchmark.h>

#include <libslam/filter/ekf_slam.hpp>
#include <libslam/pipeline/factory.hpp>

namespace {

using namespace libslam;
using bench::MrptFilter;
using bench::RingStep;
using bench::RingWorld;

class LibslamFilter {
 public:
  explicit LibslamFilter(const char* frame, const char* adaptation = "off")
      : filter_(parts(frame, adaptation)) {}

  void process(const RingStep& step, bool first) {
    if (!first) filter_.propagate(&step.action);
    benchmark::DoNotOptimize(filter_.update(step.features));
  }
  Eigen::Vector3d pose() const { return filter_.state().estimate(filter_.pose()); }
  std::size_t landmarks() const { return filter_.registry().size(); }

 private:
  static EkfSlamParts parts(const char* frame, const char* adaptation) {
    Parameters parameters;
    parameters.filter.error_frame = frame;
    parameters.association.gate_probability = 1.0;
    parameters.policies.noise_adaptation.method = adaptation;
    return make_filter_parts(parameters);
  }

  EkfSlam filter_;
};

/// MRPT leaves out the motion before the first landmark by itself.
class MrptRingFilter {
 public:
  explicit MrptRingFilter(MrptFilter::Method method)
      : filter_(method, RingWorld::kSigmaRange, RingWorld::kSigmaBearing) {}

  void process(const RingStep& step, bool) { filter_.process(step.log); }
  Eigen::Vector3d pose() const { return filter_.pose(); }
  std::size_t landmarks() const { return filter_.landmarks(); }

 private:
  MrptFilter filter_;
};

/// What is wrong with a filter after `last`, or nothing: a filter that lost its way is not timed.
template <class Filter>
std::optional<std::string> defect(const Filter& filter, const RingStep& last,
                                  std::int64_t landmarks) {
  if (filter.landmarks() != static_cast<std::size_t>(landmarks)) return "the map is not complete";
  const Eigen::Vector3d error = filter.pose() - last.truth;
  if (!(error.head<2>().norm() < 1.0)) return "the filter diverged";
  return std::nullopt;
}

/// The first lap, in which the map grows, is not timed.
template <class Filter, class... Settings>
void step(benchmark::State& state, Settings... settings) {
  const std::vector<RingStep>& lap = bench::ring_world(static_cast<int>(state.range(0))).lap;
  Filter filter(settings...);
  for (const RingStep& step : lap) filter.process(step, &step == &lap.front());
  std::size_t next = 0, done = lap.size() - 1;
  for (auto _ : state) {
    filter.process(lap[next], false);
    done = next;
    next = (next + 1) % lap.size();
  }
  if (const auto found = defect(filter, lap[done], state.range(0)))
    state.SkipWithError(found->c_str());
  state.counters["steps"] = 1;
}

void sizes_up_to(benchmark::internal::Benchmark* family, int largest) {
  for (int landmarks = 25; landmarks <= largest; landmarks *= 2) family->Arg(landmarks);
  family->Unit(benchmark::kMillisecond);
}

void step_invariant(benchmark::State& state) {
  step<LibslamFilter>(state, "right_invariant");
}
void step_adaptive(benchmark::State& state) {
  step<LibslamFilter>(state, "right_invariant", "residual");
}
void step_standard(benchmark::State& state) {
  step<LibslamFilter>(state, "standard");
}
void step_mrpt(benchmark::State& state) {
  step<MrptRingFilter>(state, MrptFilter::Method::kDefault);
}
void step_mrpt_davison(benchmark::State& state) {
  step<MrptRingFilter>(state, MrptFilter::Method::kDavison);
}

BENCHMARK(step_invariant)->Name("step/invariant")->Apply([](auto* b) { sizes_up_to(b, 1600); });
// What the adaptation of R costs: against step/invariant.
BENCHMARK(step_adaptive)->Name("step/adaptive")->Apply([](auto* b) { sizes_up_to(b, 1600); });
BENCHMARK(step_standard)->Name("step/standard")->Apply([](auto* b) { sizes_up_to(b, 1600); });
// MRPT takes half a second per step with 800 landmarks.
BENCHMARK(step_mrpt)->Name("step/mrpt_default")->Apply([](auto* b) { sizes_up_to(b, 200); });
BENCHMARK(step_mrpt_davison)->Name("step/mrpt_davison")->Apply([](auto* b) {
  sizes_up_to(b, 400);
});

}  // namespace
