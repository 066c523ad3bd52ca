// SLAM among straight walls, end to end.

#include <limits>
#include <tests/support/room_world.hpp>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/association/sequential_compatibility.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/measurement/line.hpp>
#include <libslam/motion/arc.hpp>
#include <libslam/motion/odometry_increment.hpp>
#include <libslam/state/chi_square.hpp>

using namespace libslam;
using libslam::testing::RoomWorld;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

EkfSlamParts parts_with(const char* frame, bool known,
                        const CalibrationParameters& calibration = {}) {
  EkfSlamParts parts;
  parts.motion = std::make_unique<OdometryIncrement>(MotionParameters{}, calibration);
  parts.measurement = std::make_unique<LineMeasurement>();
  if (known)
    parts.associator = std::make_unique<KnownAssociation>(kInfinity);
  else
    parts.associator = std::make_unique<SequentialCompatibility>(9.2, 25.0);
  parts.frame = make_error_frame(frame);
  parts.extent_gap = 0.6;
  return parts;
}

struct Error {
  double position, heading, map;
};

Eigen::Vector2d direction(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

/// The largest distance of an end of a wall from the line of the map that is nearest to it.
Error error_of(const EkfSlam& filter, const RoomWorld& world) {
  const Eigen::Vector3d pose = filter.state().estimate(filter.pose());
  Error error{(pose - world.pose).head<2>().norm(), std::abs(wrap_angle(pose[2] - world.pose[2])),
              0.0};
  for (const LandmarkEstimate& line : filter.landmarks()) {
    double nearest = kInfinity;
    for (const auto& [from, to] : world.walls) {
      const Eigen::Vector2d n = direction(line.mean[0]);
      nearest = std::min(nearest, std::max(std::abs(n.dot(from) - line.mean[1]),
                                           std::abs(n.dot(to) - line.mean[1])));
    }
    error.map = std::max(error.map, nearest);
  }
  return error;
}

}  // namespace

TEST(LineSlam, NoiselessRunsReachZeroError) {
  for (const char* frame : {"standard", "right_invariant"})
    for (const bool known : {true, false}) {
      std::mt19937_64 random(61);
      RoomWorld world;
      EkfSlamParts parts = parts_with(frame, known);
      parts.start = world.pose;
      EkfSlam filter(std::move(parts));
      for (int k = 0; k < 300; ++k) {
        const MotionAction action = world.drive(random, 0.0);
        filter.propagate(&action);
        filter.update(world.observe(random, 0.0));
      }
      const Error error = error_of(filter, world);
      EXPECT_LT(error.position, 1e-9) << frame << known;
      EXPECT_LT(error.heading, 1e-9) << frame << known;
      EXPECT_LT(error.map, 1e-8) << frame << known;
      EXPECT_EQ(filter.registry().size(), world.walls.size()) << frame << known;
    }
}

// What the filter is told is tiny noise on an odometry that is wrong by its calibration alone; the
// prior, ten thousand times as wide, gives way. Linearizing the first steps, 2 cm off, leaves 4e-5.
TEST(LineSlam, CalibrationOfANoiselessRunReachesTheTruth) {
  constexpr double kSpeed = 1.04, kTurn = 0.97, kBias = -0.06;
  CalibrationParameters calibration;
  calibration.scale_speed.enabled = calibration.scale_turn.enabled = true;
  calibration.bias_turn.enabled = true;
  for (const char* frame : {"standard", "right_invariant"}) {
    std::mt19937_64 random(62);
    RoomWorld world;
    world.sigma_alpha = world.sigma_r = 1e-6;
    EkfSlamParts parts = parts_with(frame, true, calibration);
    parts.start = world.pose;
    EkfSlam filter(std::move(parts));
    filter.update(world.observe(random, 0.0));
    for (int k = 0; k < 300; ++k) {
      const double length = 0.3, turn = 0.06 + 0.05 * std::sin(0.3 * k);
      world.move(follow_arc({length, 0.0, turn}).increment);
      MotionAction action;
      action.dt = 0.1;
      const double measured = length / kSpeed;
      action.increment = follow_arc({measured, 0.0, (turn - kBias * measured) / kTurn}).increment;
      action.cov_increment = 1e-12 * Eigen::Matrix3d::Identity();
      filter.propagate(&action);
      filter.update(world.observe(random, 0.0));
    }
    const Error error = error_of(filter, world);
    EXPECT_LT(error.position, 1e-4) << frame;
    EXPECT_LT(error.heading, 1e-4) << frame;
    EXPECT_LT(error.map, 1e-4) << frame;
    const double truth[] = {kSpeed, kTurn, kBias};
    const std::vector<CalibrationValue> found = filter.calibration();
    ASSERT_EQ(found.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(found[i].mean, truth[i], 1e-5) << frame << found[i].name;
      EXPECT_TRUE(found[i].observable) << found[i].name;
    }
  }
}

// Fifty runs; their mean is chi-square with 150 degrees of freedom over fifty.
TEST(LineSlam, TheFinalPoseIsAsGoodAsTheFilterSays) {
  constexpr int kRuns = 50;
  double nees = 0.0;
  for (unsigned seed = 200; seed < 200 + kRuns; ++seed) {
    std::mt19937_64 random(seed);
    RoomWorld world;
    EkfSlamParts parts = parts_with("right_invariant", true);
    parts.start = world.pose;
    EkfSlam filter(std::move(parts));
    for (int k = 0; k < 150; ++k) {
      const MotionAction action = world.drive(random, 1.0);
      filter.propagate(&action);
      filter.update(world.observe(random, 1.0));
    }
    Eigen::Vector3d error = filter.state().estimate(filter.pose()) - world.pose;
    error[2] = wrap_angle(error[2]);
    const Eigen::Matrix3d cov = filter.state().covariance_of(filter.pose());
    nees += error.dot(cov.llt().solve(error)) / kRuns;
  }
  EXPECT_LT(nees, chi_square_quantile(0.999, 3 * kRuns) / kRuns);
  EXPECT_GT(nees, chi_square_quantile(0.001, 3 * kRuns) / kRuns);
}

TEST(LineSlam, AWallBegunTwiceIsMadeOne) {
  std::mt19937_64 random(63);
  RoomWorld world;
  EkfSlamParts parts = parts_with("right_invariant", true);
  parts.start = world.pose;
  parts.merging.emplace(MergingOptions{40, 9.2, 0.6});
  EkfSlam filter(std::move(parts));
  std::size_t most = 0;
  for (int k = 0; k < 40; ++k) {
    const MotionAction action = world.drive(random, 0.0);
    filter.propagate(&action);
    std::vector<Feature> seen = world.observe(random, 0.0);
    if (k >= 30)
      for (Feature& feature : seen) feature.id += 100;
    filter.update(seen);
    if (k < 39) most = std::max(most, filter.registry().size());
  }
  EXPECT_GT(most, filter.registry().size() + 3);
  EXPECT_LE(filter.registry().size(), world.walls.size());
  EXPECT_EQ(filter.state().blocks().size(), 1 + filter.registry().size());
  EXPECT_LT(error_of(filter, world).map, 1e-8);
  EXPECT_LT(error_of(filter, world).position, 1e-9);
}

TEST(LineSlam, TheExtentGrowsToWhatWasSeen) {
  std::mt19937_64 random(64);
  RoomWorld world;
  EkfSlamParts parts = parts_with("right_invariant", true);
  parts.start = world.pose;
  EkfSlam filter(std::move(parts));
  double before = 0.0;
  for (const double part : {0.2, 0.5, 1.0, 0.3}) {
    std::vector<Feature> seen = world.observe(random, 0.0);
    seen.resize(1);
    const double begin = seen[0].extent->begin;
    seen[0].extent->end = begin + part * (seen[0].extent->end - begin);
    filter.update(seen);
    const Extent extent = *filter.landmarks()[0].extent;
    const auto& [from, to] = world.walls[static_cast<std::size_t>(seen[0].id)];
    before = std::max(before, part);
    EXPECT_NEAR(extent.length(), before * (to - from).norm(), 1e-9);
  }
}

// A run that is cut in two, its map saved in between, is the run in one piece.
TEST(LineSlam, ASavedMapOfLinesGoesOnAsIfNothingHadHappened) {
  const auto step = [](EkfSlam& filter, RoomWorld& world, std::mt19937_64& random) {
    const MotionAction action = world.drive(random, 1.0);
    filter.propagate(&action);
    filter.update(world.observe(random, 1.0));
  };
  for (const char* frame : {"standard", "right_invariant"}) {
    std::mt19937_64 random(65);
    RoomWorld world;
    EkfSlamParts parts = parts_with(frame, false);
    parts.start = world.pose;
    EkfSlam whole(std::move(parts));
    for (int k = 0; k < 60; ++k) step(whole, world, random);
    EkfSlamParts again = parts_with(frame, false);
    MapStart start;
    start.map = std::make_shared<SavedMap>(whole.saved_map());
    start.at_saved_pose = true;
    again.map = start;
    EkfSlam second(std::move(again));
    std::mt19937_64 random_again = random;
    RoomWorld world_again = world;
    for (int k = 0; k < 60; ++k) {
      step(whole, world, random);
      step(second, world_again, random_again);
    }
    EXPECT_LT(
        (second.state().estimate(second.pose()) - whole.state().estimate(whole.pose())).norm(),
        1e-9);
    const auto map = whole.landmarks(), map_again = second.landmarks();
    ASSERT_EQ(map.size(), map_again.size());
    for (std::size_t i = 0; i < map.size(); ++i) {
      EXPECT_EQ(map_again[i].type, "line");
      EXPECT_LT((map[i].mean - map_again[i].mean).norm(), 1e-8);
      ASSERT_TRUE(map_again[i].extent);
      EXPECT_NEAR(map[i].extent->length(), map_again[i].extent->length(), 1e-8);
    }
  }
}
