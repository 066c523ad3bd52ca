#include <algorithm>
#include <bench/preloaded_log.hpp>
#include <cstdlib>
#include <support/temporary_directory.hpp>

#include <Eigen/Dense>
#include <mrpt/obs/CObservationBearingRange.h>

#include <libslam/io/importers/victoria_park.hpp>
#include <libslam/io/rawlog_player.hpp>

namespace libslam::bench {

namespace {

using mrpt::obs::CObservationBearingRange;

PreloadedLog preload(const std::string& file) {
  RawlogPlayer player(file);
  PreloadedLog steps;
  while (auto step = player.next())
    if (step->action && step->frame) steps.push_back(std::move(*step));
  return steps;
}

CObservationBearingRange::Ptr sightings_of(const LogStep& step) {
  return step.frame->getObservationByClass<CObservationBearingRange>();
}

void state_sensor_range(PreloadedLog& log) {
  float largest = 0.0F;
  for (const LogStep& step : log)
    for (const auto& measured : sightings_of(step)->sensedData)
      largest = std::max(largest, measured.range);
  for (const LogStep& step : log) sightings_of(step)->maxSensorDistance = largest;
}

std::filesystem::path data_directory() {
  if (const char* configured = std::getenv("LIBSLAM_DATA")) return configured;
  return std::filesystem::path(__FILE__).parent_path() / "../../../shared/data";
}

}  // namespace

const PreloadedLog& kf_slam_demo() {
  static const PreloadedLog log = preload("/usr/share/mrpt/datasets/kf-slam_demo.rawlog");
  return log;
}

const std::optional<PreloadedLog>& victoria_park() {
  static const std::optional<PreloadedLog> log = []() -> std::optional<PreloadedLog> {
    const auto source = data_directory() / "victoria_park";
    if (!std::filesystem::is_directory(source)) return std::nullopt;
    const test::TemporaryDirectory scratch;
    const std::string rawlog = (scratch.path() / "victoria_park.rawlog").string();
    VictoriaParkOptions options;
    options.association = VictoriaParkOptions::Association::kIsam;
    write_imported_log(import_victoria_park(source.string(), options), rawlog);
    PreloadedLog steps = preload(rawlog);
    state_sensor_range(steps);
    return steps;
  }();
  return log;
}

Eigen::Vector2d mean_sigmas(const PreloadedLog& log) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (const LogStep& step : log)
    for (const auto& measured : sightings_of(step)->sensedData) {
      sum += Eigen::Vector2d(measured.covariance(0, 0), measured.covariance(1, 1));
      ++count;
    }
  return (sum / count).cwiseSqrt();
}

}  // namespace libslam::bench
