#include <set>

#include <gtest/gtest.h>

#include <libslam/simulation/ray_caster.hpp>
#include <libslam/simulation/world.hpp>

namespace libslam {
namespace {

TEST(RandomWorld, FillsItsExtentAndClosesItsLap) {
  WorldParameters p;
  p.landmarks = 4000;
  p.size_x = 200;
  p.size_y = 50;
  const World world = make_random_world(p);
  ASSERT_EQ(world.landmarks.size(), 4000U);
  Eigen::Array2d squares = Eigen::Array2d::Zero();
  std::set<std::int64_t> ids;
  for (const auto& landmark : world.landmarks) {
    ids.insert(landmark.id);
    ASSERT_EQ(landmark.position.size(), 2);
    const Eigen::Array2d part = landmark.position.array() / Eigen::Array2d(100, 25);
    EXPECT_LE(part.abs().maxCoeff(), 1.0);
    squares += part.square();
  }
  EXPECT_EQ(ids.size(), 4000U);
  // Uniform in [-1, 1]: variance 1/3, standard deviation of the square sqrt(4/45).
  const double tolerance = 4.0 * std::sqrt(4.0 / 45.0 / 4000.0);
  EXPECT_NEAR(squares.x() / 4000, 1.0 / 3.0, tolerance);
  EXPECT_NEAR(squares.y() / 4000, 1.0 / 3.0, tolerance);
  double area = 0.0;  // positive: counter-clockwise
  for (std::size_t i = 0; i < world.way_points.size(); ++i) {
    const auto& a = world.way_points[i];
    const auto& b = world.way_points[(i + 1) % world.way_points.size()];
    area += a.x() * b.y() - a.y() * b.x();
  }
  EXPECT_GT(area, 0.0);
  EXPECT_EQ(Eigen::Vector2d(world.T_world_start.head<2>()), world.way_points.front());
}

TEST(RandomWorld, DependsOnItsSeedAlone) {
  WorldParameters p;
  const World a = make_random_world(p), b = make_random_world(p);
  EXPECT_EQ(a.landmarks[3].position, b.landmarks[3].position);
  p.seed = 2;
  EXPECT_NE(a.landmarks[3].position, make_random_world(p).landmarks[3].position);
}

TEST(RandomWorld, HeightsOnlyWhereAsked) {
  WorldParameters p;
  p.max_height = 2.0;
  for (const auto& landmark : make_random_world(p).landmarks) {
    ASSERT_EQ(landmark.position.size(), 3);
    EXPECT_GE(landmark.position.z(), 0.0);
    EXPECT_LE(landmark.position.z(), 2.0);
  }
}

TEST(Rooms, LapGoesThroughDoorsAndNeverThroughWalls) {
  WorldParameters p;
  p.rooms_x = 4;
  p.rooms_y = 3;
  const World world = make_rooms(p);
  EXPECT_EQ(world.way_points.size(), 2U * 12U - 1U);
  const RayCaster walls(world.walls, {});
  for (std::size_t i = 1; i < world.way_points.size(); ++i)
    EXPECT_TRUE(walls.sees(world.way_points[i - 1], world.way_points[i])) << i;
  EXPECT_FALSE(walls.sees({3, 2.5}, {9, 4.5})) << "beside the door";
}

TEST(Rooms, OuterWallsAreClosedAndDoorsAsWideAsAsked) {
  WorldParameters p;
  p.rooms_x = 2;
  p.rooms_y = 1;
  p.door_width = 1.2;
  const RayCaster walls(make_rooms(p).walls, {});
  for (int i = 0; i < 720; ++i) {
    const double a = i * M_PI / 360.0;
    EXPECT_LT(walls.cast({3, 2.5}, {std::cos(a), std::sin(a)}, 100.0), 12.0);
  }
  EXPECT_DOUBLE_EQ(walls.cast({3, 2.5 + 0.59}, {1, 0}, 100.0), 9.0);
  EXPECT_DOUBLE_EQ(walls.cast({3, 2.5 + 0.61}, {1, 0}, 100.0), 3.0);
}

TEST(Rooms, LandmarksStandInsideBesideTheirWallAndNotInDoors) {
  WorldParameters p;
  p.landmarks = 500;
  for (const auto& landmark : make_rooms(p).landmarks) {
    const double x = std::fmod(landmark.position.x(), p.room_size_x);
    const double y = std::fmod(landmark.position.y(), p.room_size_y);
    const double dx = std::min(x, p.room_size_x - x), dy = std::min(y, p.room_size_y - y);
    EXPECT_NEAR(std::min(dx, dy), 0.05, 0.05);
    const double along = dx < dy ? y - p.room_size_y / 2 : x - p.room_size_x / 2;
    EXPECT_GE(std::abs(along), p.door_width / 2 - 1e-9);
  }
}

}  // namespace
}  // namespace libslam
