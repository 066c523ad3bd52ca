#include <random>
#include <tests/support/floor_plan.hpp>

#include <gtest/gtest.h>

#include <libslam/filter/surface_grid.hpp>

using namespace libslam;
using libslam::testing::FloorPlan;
using libslam::testing::ring_corridor;

namespace {

constexpr double kSigmaRange = 0.02;  // [m]
constexpr double kMinSupport = 0.55, kMargin = 0.1;
const SurfaceGrid::Judge kAll = [](const SurfaceMatch&) { return true; };
const PoseWindow kWindow{4.0, to_radians(20.0)};

/// Scans along x, every half metre, in the frame of the world.
std::vector<SurfaceScan> drive(const FloorPlan& plan, const Eigen::Vector3d& start, double length,
                               std::mt19937_64& random) {
  std::vector<SurfaceScan> scans;
  for (double x = 0.0; x <= length; x += 0.5) {
    const Eigen::Vector3d pose = compose_poses(start, {x, 0.0, 0.0});
    SurfaceScan& scan = scans.emplace_back();
    scan.origin = pose.head<2>();
    for (const Eigen::Vector2d& p : plan.scan(pose, kSigmaRange, random))
      scan.points.push_back(transform_point(pose, p));
  }
  return scans;
}

/// What is seen on 6 m of the way to `pose`, in its frame.
std::vector<Eigen::Vector2d> view(const FloorPlan& plan, const Eigen::Vector3d& pose,
                                  std::mt19937_64& random) {
  std::vector<Eigen::Vector2d> points;
  for (const SurfaceScan& scan : drive(plan, compose_poses(pose, {-6.0, 0.0, 0.0}), 6.0, random))
    for (const Eigen::Vector2d& p : scan.points) points.push_back(transform_back(pose, p));
  return points;
}

/// A corridor along x without any feature but its two walls.
FloorPlan bare_corridor() {
  FloorPlan plan;
  plan.walls = {{{-40, -1}, {60, -1}}, {{-40, 1}, {60, 1}}};
  return plan;
}

/// A corridor along x with the same niche every 3 m.
FloorPlan regular_corridor() {
  FloorPlan plan = bare_corridor();
  for (double x = -39.0; x < 60.0; x += 3.0) plan.add_box({x, -1.0}, {x + 0.5, -0.5});
  return plan;
}

}  // namespace

// Many plans, starts and errors of the estimate; the bound is the width of a cell and the bearing
// that it spans at the far end of a view.
TEST(SurfaceGrid, FindsTheViewAgainFromAnywhereInTheWindow) {
  int distinct = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const FloorPlan plan = ring_corridor(seed);
    const SurfaceGrid grid(drive(plan, {4, 0, 0}, 10.0, random));
    const Eigen::Vector3d truth(12.0 + uniform(random), 0.3 * uniform(random),
                                0.05 * uniform(random));
    const Eigen::Vector3d estimate(truth.x() + 3.5 * uniform(random),
                                   truth.y() + 3.5 * uniform(random),
                                   truth.z() + to_radians(18.0) * uniform(random));
    const auto match =
        grid.search(view(plan, truth, random), estimate, kWindow, kMinSupport, kMargin, kAll);
    ASSERT_TRUE(match) << "seed " << seed;
    const Eigen::Vector3d error = relative_pose(truth, match->T_grid_view);
    EXPECT_LT(error.head<2>().norm(), 0.1) << "seed " << seed;
    EXPECT_LT(std::abs(error.z()), to_radians(0.8)) << "seed " << seed;
    if (match->score.support - match->rival > kMargin) ++distinct;
    EXPECT_LT(match->score.contradicted, 0.1) << "seed " << seed;
  }
  EXPECT_GE(distinct, 10);  // cupboards at random may repeat; most places differ from all others
}

// The bound of a block never hides a better pose: with a margin as large as the least support all
// is looked into, and the same pose comes out.
TEST(SurfaceGrid, PrunesNothingThatCounts) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    std::mt19937_64 random(seed);
    const FloorPlan plan = ring_corridor(seed);
    const SurfaceGrid grid(drive(plan, {4, 0, 0}, 10.0, random));
    const auto points = view(plan, {12.0, 0.1, 0.02}, random);
    const PoseWindow window{1.5, to_radians(4.0)};
    const Eigen::Vector3d estimate(11.2, -0.8, 0.0);
    const auto fast = grid.search(points, estimate, window, kMinSupport, kMargin, kAll);
    const auto all = grid.search(points, estimate, window, kMinSupport, kMinSupport, kAll);
    ASSERT_TRUE(fast && all);
    EXPECT_EQ(fast->T_grid_view, all->T_grid_view);
    EXPECT_EQ(fast->score.support, all->score.support);
  }
}

// Along a bare corridor a view fits everywhere, in a regular one at every niche: there is a rival.
TEST(SurfaceGrid, TellsThatACorridorIsAmbiguous) {
  for (const FloorPlan& plan : {bare_corridor(), regular_corridor()})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      std::mt19937_64 random(seed);
      const SurfaceGrid grid(drive(plan, {0, 0, 0}, 14.0, random));
      const auto match = grid.search(view(plan, {9.0, 0.0, 0.0}, random), {10.0, 0.5, 0.1}, kWindow,
                                     kMinSupport, kMargin, kAll);
      if (match) {
        EXPECT_LT(match->score.support - match->rival, kMargin) << "seed " << seed;
      }
    }
}

// A view of another building is not found, contradicts what was seen, or has a rival.
TEST(SurfaceGrid, DoesNotFindAnotherBuilding) {
  int accepted = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed);
    const SurfaceGrid grid(drive(ring_corridor(seed), {4, 0, 0}, 10.0, random));
    const auto match = grid.search(view(ring_corridor(seed + 100), {12, 0, 0}, random),
                                   {11.0, 0.5, 0.1}, kWindow, kMinSupport, kMargin, kAll);
    if (match && match->score.support - match->rival >= kMargin && match->score.contradicted <= 0.1)
      ++accepted;
  }
  EXPECT_EQ(accepted, 0);
}

TEST(SurfaceGrid, NeedsPoints) {
  EXPECT_THROW(SurfaceGrid({}), std::invalid_argument);
  const SurfaceGrid grid(std::vector<SurfaceScan>{{{0, 0}, {{1, 0}}}});
  EXPECT_FALSE(grid.search({}, {0, 0, 0}, kWindow, kMinSupport, kMargin, kAll));
  EXPECT_EQ(grid.score({}, {0, 0, 0}).support, 0.0);
}

// A point on a surface, one that a beam went through, and one behind all that was seen.
TEST(SurfaceGrid, ScoresPoints) {
  const SurfaceGrid grid(std::vector<SurfaceScan>{{{0, 0}, {{4.05, 0.05}}}});
  const auto score = [&](double x, double y) {
    const std::vector<Eigen::Vector2d> point{{x, y}};
    return grid.score(point, Eigen::Vector3d::Zero());
  };
  EXPECT_EQ(score(4.05, 0.05).support, 1.0);
  EXPECT_EQ(score(2.0, 0.05).contradicted, 1.0);
  EXPECT_EQ(score(2.0, 0.05).support, 0.0);
  EXPECT_EQ(score(2.0, 0.8).unknown, 1.0);
  EXPECT_EQ(score(30.0, 0.0).unknown, 1.0);
}
