// Lines: extraction from one scan against the number of beams, and one step of line SLAM against
// the number of lines in the map.

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <benchmark/benchmark.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <libslam/filter/ekf_slam.hpp>
#include <libslam/frontend/scan_lines.hpp>
#include <libslam/pipeline/factory.hpp>
#include <libslam/simulation/ray_caster.hpp>

namespace {

using namespace libslam;

constexpr double kSigmaRange = 0.01;  // [m]

/// An office of 12 x 8 m: four walls with a door, a desk, a shelf and an oblique partition.
std::vector<Wall> office() {
  return {{{-6, -4}, {6, -4}},  {{6, -4}, {6, 4}},      {{6, 4}, {-1, 4}},
          {{-2, 4}, {-6, 4}},   {{-6, 4}, {-6, -4}},    {{-1, 4}, {-1, 7}},
          {{-2, 4}, {-2, 7}},   {{2, 1}, {3.6, 1}},     {{3.6, 1}, {3.6, 2}},
          {{3.6, 2}, {2, 2}},   {{2, 2}, {2, 1}},       {{5.6, -3}, {5.6, -1}},
          {{5.6, -1}, {6, -1}}, {{-5, -2}, {-3, -3.5}}, {{0.5, 3}, {1.5, 3.6}}};
}

/// The office from its middle, seen over `aperture` [rad].
mrpt::obs::CSensoryFrame office_scan(std::size_t beams, double aperture) {
  const RayCaster world(office(), {});
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  scan->aperture = static_cast<float>(aperture);
  scan->maxRange = 30.0F;
  scan->resizeScan(beams);
  std::mt19937_64 random(72);
  std::normal_distribution<double> noise(0.0, kSigmaRange);
  for (std::size_t i = 0; i < beams; ++i) {
    const double bearing =
        aperture * (static_cast<double>(i) / static_cast<double>(beams - 1) - 0.5) + 0.3;
    const double range =
        world.cast({-1.3, -0.4}, {std::cos(bearing), std::sin(bearing)}, 30.0) + noise(random);
    scan->setScanRange(i, static_cast<float>(range));
    scan->setScanRangeValidity(i, true);
  }
  mrpt::obs::CSensoryFrame frame;
  frame.insert(scan);
  return frame;
}

/// From MRPT's observation to features.
void extract_lines(benchmark::State& state) {
  const auto beams = static_cast<std::size_t>(state.range(0));
  const auto frame = office_scan(beams, beams > 361 ? 1.5 * kPi : kPi);
  ScanLines frontend(FrontendParameters{}, "");
  std::vector<FeatureBatch> batches;
  std::size_t lines = 0;
  for (auto _ : state) {
    frontend.extract(frame, batches);
    lines = batches.empty() ? 0 : batches.front().size();
  }
  if (lines < 4) state.SkipWithError("walls were not found");
  state.counters["steps"] = 1;
  state.counters["lines"] = static_cast<double>(lines);
}

struct LineStep {
  MotionAction action;
  FeatureBatch features;
  Eigen::Vector3d truth;  ///< in the frame of the first pose
};

/// Laps on a circle inside a ring of walls 2 m apart, tilted against it to one side and the other
/// in turn, so that they hold the robot along its way, too. It passes one wall per step and sees
/// the eight nearest ones, with identities, always from the same side.
class WallRing {
 public:
  explicit WallRing(int walls) : walls_(walls), radius_(2.0 * walls / (2.0 * kPi)) {
    for (int k = 0; k < walls; ++k) lap.push_back(step(k));
  }

  std::vector<LineStep> lap;

 private:
  static constexpr int kSeen = 8;
  static constexpr double kInside = 3.0, kLength = 1.6;  // [m]
  static constexpr double kTilt = 0.25;                  // [rad]
  static constexpr double kSigmaAlpha = 0.003, kSigmaR = 0.01;
  static constexpr double kSigmaXY = 0.01, kSigmaHeading = 1e-4;

  Eigen::Isometry2d pose(int step) const {
    const double angle = 2.0 * kPi * step / walls_;
    return Eigen::Rotation2Dd(angle) * Eigen::Translation2d(radius_ - kInside, 0.0) *
           Eigen::Rotation2Dd(0.5 * kPi);
  }
  static Eigen::Vector3d vector_of(const Eigen::Isometry2d& T) {
    return {T.translation().x(), T.translation().y(), Eigen::Rotation2Dd(T.linear()).angle()};
  }

  LineStep step(int k) {
    LineStep step;
    step.action.dt = 1.0;
    step.action.increment =
        vector_of(pose(k - 1).inverse() * pose(k)) +
        Eigen::Vector3d(kSigmaXY * normal_(random_), kSigmaXY * normal_(random_),
                        kSigmaHeading * normal_(random_));
    step.action.cov_increment =
        Eigen::Vector3d(kSigmaXY, kSigmaXY, kSigmaHeading).cwiseAbs2().asDiagonal();
    for (int i = k - kSeen / 2; i < k + kSeen / 2; ++i) step.features.push_back(wall(i, pose(k)));
    step.truth = vector_of(pose(0).inverse() * pose(k));
    return step;
  }

  Feature wall(int index, const Eigen::Isometry2d& T_world_robot) {
    const double angle = 2.0 * kPi * index / walls_;
    const double tilt = index % 2 != 0 ? kTilt : -kTilt;
    const Eigen::Vector2d along = Eigen::Rotation2Dd(angle + tilt) * Eigen::Vector2d::UnitY();
    const Eigen::Vector2d middle = Eigen::Rotation2Dd(angle) * Eigen::Vector2d(radius_, 0.0);
    const Eigen::Isometry2d T_robot_world = T_world_robot.inverse();
    const Eigen::Vector2d a = T_robot_world * Eigen::Vector2d(middle - 0.5 * kLength * along);
    const Eigen::Vector2d b = T_robot_world * Eigen::Vector2d(middle + 0.5 * kLength * along);
    const Eigen::Vector2d direction = (b - a).normalized();
    Eigen::Vector2d n(direction.y(), -direction.x());
    if (n.dot(a) < 0.0) n = -n;
    const Eigen::Vector2d left(-n.y(), n.x());
    Feature feature;
    feature.id = (index + walls_) % walls_;
    feature.z = Eigen::Vector2d(std::atan2(n.y(), n.x()) + kSigmaAlpha * normal_(random_),
                                n.dot(a) + kSigmaR * normal_(random_));
    feature.cov = Eigen::Vector2d(kSigmaAlpha, kSigmaR).cwiseAbs2().asDiagonal();
    feature.extent =
        Extent{std::min(left.dot(a), left.dot(b)), std::max(left.dot(a), left.dot(b)), 0.01, 0.01};
    return feature;
  }

  int walls_;
  double radius_;
  std::mt19937_64 random_{73};
  std::normal_distribution<double> normal_;
};

/// The first lap, in which the map grows, is not timed.
void line_step(benchmark::State& state) {
  const WallRing ring(static_cast<int>(state.range(0)));
  Parameters parameters;
  parameters.measurement.model = "line";
  parameters.association.gate_probability = 1.0;
  EkfSlam filter(make_filter_parts(parameters));
  const auto process = [&filter](const LineStep& step, bool first) {
    if (!first) filter.propagate(&step.action);
    benchmark::DoNotOptimize(filter.update(step.features));
  };
  for (const LineStep& step : ring.lap) process(step, &step == &ring.lap.front());
  std::size_t next = 0, done = 0;
  for (auto _ : state) {
    process(ring.lap[next], false);
    done = next;
    next = (next + 1) % ring.lap.size();
  }
  const Eigen::Vector3d error = filter.state().estimate(filter.pose()) - ring.lap[done].truth;
  if (filter.registry().size() != static_cast<std::size_t>(state.range(0)))
    state.SkipWithError("the map is not complete");
  else if (!(error.head<2>().norm() < 1.0))
    state.SkipWithError("the filter diverged");
  state.counters["steps"] = 1;
}

constexpr auto kMs = benchmark::kMillisecond;
BENCHMARK(extract_lines)->Name("lines/extract")->Arg(180)->Arg(361)->Arg(1081)->Unit(kMs);
BENCHMARK(line_step)->Name("lines/step")->RangeMultiplier(2)->Range(32, 1024)->Unit(kMs);

}  // namespace
