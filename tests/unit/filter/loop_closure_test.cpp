#include <limits>
#include <random>
#include <tests/support/floor_plan.hpp>

#include <gtest/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/measurement/range_bearing.hpp>
#include <libslam/motion/odometry_increment.hpp>
#include <libslam/state/chi_square.hpp>

using namespace libslam;
using libslam::testing::FloorPlan;
using libslam::testing::ring_corridor;

namespace {

LoopClosureOptions options() {
  LoopClosureOptions options;
  options.min_way = 15.0;
  options.window = {6.0, to_radians(20.0)};
  options.min_support = 0.55;
  options.min_margin = 0.1;
  options.max_contradicted = 0.1;
  options.joint_gate = chi_square_quantile(0.99, 3);
  options.confirmations = 2;
  options.confirmation_distance = 2.0;
  return options;
}

EkfSlamParts parts(bool closing) {
  EkfSlamParts parts;
  parts.motion = std::make_unique<OdometryIncrement>(MotionParameters{}, CalibrationParameters{});
  parts.measurement = std::make_unique<RangeBearing>();
  parts.associator = std::make_unique<KnownAssociation>(std::numeric_limits<double>::infinity());
  parts.frame = make_error_frame("right_invariant");
  parts.delayed.emplace(DelayedPoseSpacing{2.0, to_radians(30.0)});
  if (closing) parts.loop_closure.emplace(options());
  return parts;
}

/// Increments once around the ring and 14 m on: straight steps, turns on the spot.
std::vector<Eigen::Vector3d> ring_way() {
  std::vector<Eigen::Vector3d> way;
  const auto straight = [&](double length) {
    for (double done = 0.0; done < length - 1e-9; done += 0.25) way.push_back({0.25, 0.0, 0.0});
  };
  const auto left = [&] {
    for (int i = 0; i < 6; ++i) way.push_back({0.0, 0.0, to_radians(15.0)});
  };
  straight(20.0);
  for (const double side : {18.0, 24.0, 18.0}) {
    left();
    straight(side);
  }
  left();
  straight(18.0);
  return way;
}

struct Result {
  Trajectory smoothed;
  std::vector<Eigen::Vector3d> truth;
  Eigen::VectorXd last;  // all estimates are behind it
  Eigen::Index dimension = 0;
  LoopCounts counts;
  std::vector<LoopMatch> closed;
  std::vector<std::size_t> step_of_place;
  double final_xy = 0.0, final_heading = 0.0, largest_xy = 0.0;
};

/// Odometry that turns `drift` [rad/m] too much, unknown to the filter, and its own small noise.
Result drive(const FloorPlan& plan, const std::vector<Eigen::Vector3d>& way, double drift,
             std::uint64_t seed, bool closing, double noise = 1.0) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  EkfSlam filter(parts(closing));
  Eigen::Vector3d pose(4, 0, 0);
  const Eigen::Vector3d start = pose;
  Result run;
  for (std::size_t k = 0; k < way.size(); ++k) {
    pose = compose_poses(pose, way[k]);
    MotionAction action;
    action.dt = 0.5;
    const double distance = way[k].head<2>().norm();
    action.increment =
        way[k] + Eigen::Vector3d(0.003 * noise * normal(random), 0.001 * noise * normal(random),
                                 drift * distance + 0.001 * noise * normal(random));
    action.cov_increment = Eigen::Vector3d(0.003, 0.001, 0.001).cwiseAbs2().asDiagonal();
    filter.propagate(&action);
    filter.remember_pose(static_cast<double>(k));
    filter.look_for_loops(plan.scan(pose, 0.02, random));
    run.truth.push_back(relative_pose(start, pose));
    if (closing) run.step_of_place.resize(filter.loop_closure()->path().places().size(), k);
  }
  run.smoothed = *filter.smoothed_path();
  run.last = filter.state().estimate(filter.pose());
  run.dimension = filter.state().dimension();
  if (closing) {
    run.counts = filter.loop_closure()->counts();
    run.closed.assign(filter.loop_closure()->closed().begin(),
                      filter.loop_closure()->closed().end());
  }
  const Eigen::Vector3d error = relative_pose(run.truth.back(), run.last);
  run.final_xy = error.head<2>().norm();
  run.final_heading = std::abs(error.z());
  for (std::size_t k = 0; k < way.size(); ++k)
    run.largest_xy =
        std::max(run.largest_xy, (run.smoothed.poses[k] - run.truth[k]).head<2>().norm());
  return run;
}

/// Closures whose relative pose is off by more than 0.5 m or 5 degrees.
int wrong(const Result& run) {
  int count = 0;
  for (const LoopMatch& match : run.closed) {
    const Eigen::Vector3d T_old_new = relative_pose(run.truth[run.step_of_place[match.old_place]],
                                                    run.truth[run.step_of_place[match.new_place]]);
    const Eigen::Vector3d error = relative_pose(T_old_new, match.T_old_new);
    if (error.head<2>().norm() > 0.5 || std::abs(error.z()) > to_radians(5.0)) ++count;
  }
  return count;
}

/// The ring without a cupboard, but for its corners like a bare corridor.
FloorPlan bare_ring() {
  FloorPlan plan;
  plan.add_box({-1, -1}, {25, 19});
  plan.add_box({1, 1}, {23, 17});
  return plan;
}

}  // namespace

// 0.12 degrees per metre are 9 degrees after the loop of 80 m, and metres. Bounds at the end: up to
// 12 m of it are driven after the last closure (1.5 degrees, 0.15 m) from a match with 0.3 degrees
// and 0.05 m, of which three sigma.
TEST(LoopClosure, ClosesALoopThatTheFilterDoesNotBelieveIn) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const FloorPlan plan = ring_corridor(seed);
    const Result open = drive(plan, ring_way(), to_radians(0.12), seed, false);
    const Result closed = drive(plan, ring_way(), to_radians(0.12), seed, true);
    EXPECT_GT(open.final_xy, 1.5) << "seed " << seed;
    EXPECT_GE(closed.counts.closures, 1) << "seed " << seed;
    EXPECT_EQ(wrong(closed), 0) << "seed " << seed;
    EXPECT_LT(closed.final_xy, 0.4) << "seed " << seed;
    EXPECT_LT(closed.final_heading, to_radians(2.5)) << "seed " << seed;
    EXPECT_LT(closed.largest_xy, 0.5 * open.largest_xy) << "seed " << seed;
  }
}

TEST(LoopClosure, LeavesAloneWhatIsInPlace) {
  const Result run = drive(ring_corridor(4), ring_way(), 0.0, 4, true, 0.1);
  EXPECT_EQ(run.counts.closures, 0);
  EXPECT_GT(run.counts.in_place, 0);
}

// Between bare walls nothing tells how far along the robot is, until a corner is in view.
TEST(LoopClosure, IsNeverWrongInABareRing) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Result run = drive(bare_ring(), ring_way(), to_radians(0.12), seed, true);
    EXPECT_EQ(wrong(run), 0) << "seed " << seed;
  }
}

// A straight corridor with the same niche every 3 m, driven to and fro with an odometry that is
// 1 m too short: every niche looks like the next one.
TEST(LoopClosure, RefusesARegularCorridor) {
  FloorPlan plan;
  plan.walls = {{{-40, -1}, {60, -1}}, {{-40, 1}, {60, 1}}};
  for (double x = -39.0; x < 60.0; x += 3.0) plan.add_box({x, -1.0}, {x + 0.5, -0.5});
  std::vector<Eigen::Vector3d> way;
  for (int lap = 0; lap < 2; ++lap) {
    for (int k = 0; k < 100; ++k) way.push_back({0.25, 0.0, 0.0});
    for (int k = 0; k < 12; ++k) way.push_back({0.0, 0.0, to_radians(15.0)});
  }
  const Result run = drive(plan, way, to_radians(0.05), 1, true);
  EXPECT_EQ(wrong(run), 0);
}

TEST(LoopClosure, IsReproducible) {
  const Result first = drive(ring_corridor(1), ring_way(), to_radians(0.12), 1, true);
  const Result second = drive(ring_corridor(1), ring_way(), to_radians(0.12), 1, true);
  EXPECT_EQ(first.last, second.last);
  EXPECT_EQ(first.counts.searches, second.counts.searches);
  ASSERT_EQ(first.smoothed.poses.size(), second.smoothed.poses.size());
  for (std::size_t k = 0; k < first.smoothed.poses.size(); ++k)
    EXPECT_EQ(first.smoothed.poses[k], second.smoothed.poses[k]);
}

// Looking changes nothing before a loop is closed: state and covariance are those without it.
TEST(LoopClosure, OnlyLooksUntilItCloses) {
  std::vector<Eigen::Vector3d> way = ring_way();
  way.resize(150);
  const Result without = drive(ring_corridor(1), way, 0.0, 1, false);
  const Result with = drive(ring_corridor(1), way, 0.0, 1, true);
  EXPECT_EQ(with.counts.closures, 0);
  EXPECT_EQ(without.last, with.last);
  EXPECT_EQ(without.dimension, with.dimension);
}

TEST(LoopClosure, RefusesSenselessOptions) {
  LoopClosureOptions none = options();
  none.window.xy = 0.0;
  EXPECT_THROW(LoopClosure{none}, std::invalid_argument);
  none = options();
  none.confirmations = 0;
  EXPECT_THROW(LoopClosure{none}, std::invalid_argument);
}
