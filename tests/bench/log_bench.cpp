// Whole logs with the identities of the log, read beforehand: the pipeline from MRPT's observations
// to the record of a step against MRPT's class, on the same pairs.

#include <bench/mrpt_filter.hpp>
#include <bench/preloaded_log.hpp>

#include <benchmark/benchmark.h>

#include <libslam/config/ini_loader.hpp>
#include <libslam/pipeline/pipeline.hpp>

namespace {

using namespace libslam;
using bench::MrptFilter;
using bench::PreloadedLog;

constexpr char kStockIni[] = "/usr/share/mrpt/config_files/kf-slam/EKF-SLAM_test_2d.ini";

/// Times whole passes of a new filter; the map of the last one must have `landmarks` landmarks.
template <class MakeFilter, class CountLandmarks>
void passes(benchmark::State& state, const PreloadedLog& log, std::size_t landmarks,
            const MakeFilter& make_filter, const CountLandmarks& count_landmarks) {
  std::size_t mapped = landmarks;
  for (auto _ : state) {
    auto filter = make_filter();
    for (const LogStep& step : log) filter.process(step);
    state.PauseTiming();
    mapped = count_landmarks(filter);
    state.ResumeTiming();
  }
  if (mapped != landmarks) state.SkipWithError("wrong number of landmarks");
  state.counters["steps"] = static_cast<double>(log.size());
}

void pass_libslam(benchmark::State& state, const PreloadedLog& log, std::size_t landmarks,
                  const Parameters& parameters) {
  passes(
      state, log, landmarks, [&] { return Pipeline(parameters); },
      [](const Pipeline& p) { return p.filter().registry().size(); });
}

/// Settings of the stock ini file, with the given error frame.
void demo(benchmark::State& state, const char* frame) {
  Parameters parameters = load_kf_slam_ini(kStockIni).parameters;
  parameters.filter.error_frame = frame;
  pass_libslam(state, bench::kf_slam_demo(), 70, parameters);
}

void demo_mrpt(benchmark::State& state, MrptFilter::Method method) {
  passes(
      state, bench::kf_slam_demo(), 70, [=] { return MrptFilter(method, kStockIni); },
      [](const MrptFilter& f) { return f.landmarks(); });
}

/// The log's own noise, as in config/victoria_park_known_ids.yaml.
void park(benchmark::State& state, const char* frame) {
  if (!bench::victoria_park()) return state.SkipWithError("the data set is not there");
  Parameters parameters;
  parameters.filter.error_frame = frame;
  parameters.association.gate_probability = 1.0;
  pass_libslam(state, *bench::victoria_park(), 151, parameters);
}

void park_mrpt(benchmark::State& state, MrptFilter::Method method) {
  if (!bench::victoria_park()) return state.SkipWithError("the data set is not there");
  const PreloadedLog& log = *bench::victoria_park();
  const Eigen::Vector2d sigmas = bench::mean_sigmas(log);
  passes(
      state, log, 151, [=] { return MrptFilter(method, sigmas[0], sigmas[1]); },
      [](const MrptFilter& f) { return f.landmarks(); });
}

using Method = MrptFilter::Method;
constexpr auto kMs = benchmark::kMillisecond;
BENCHMARK_CAPTURE(demo, invariant, "right_invariant")->Unit(kMs);
BENCHMARK_CAPTURE(demo, standard, "standard")->Unit(kMs);
BENCHMARK_CAPTURE(demo_mrpt, default, Method::kDefault)->Name("demo/mrpt_default")->Unit(kMs);
BENCHMARK_CAPTURE(demo_mrpt, davison, Method::kDavison)->Name("demo/mrpt_davison")->Unit(kMs);
BENCHMARK_CAPTURE(park, invariant, "right_invariant")->Unit(kMs);
BENCHMARK_CAPTURE(park, standard, "standard")->Unit(kMs);
// One pass takes seconds.
BENCHMARK_CAPTURE(park_mrpt, default, Method::kDefault)
    ->Name("park/mrpt_default")
    ->Unit(kMs)
    ->Iterations(1);
BENCHMARK_CAPTURE(park_mrpt, davison, Method::kDavison)
    ->Name("park/mrpt_davison")
    ->Unit(kMs)
    ->Iterations(1);

}  // namespace
