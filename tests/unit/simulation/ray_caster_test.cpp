#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <libslam/simulation/ray_caster.hpp>

namespace libslam {
namespace {

Eigen::Vector2d direction_of(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

TEST(RayCaster, EmptyWorldReturnsTheRange) {
  EXPECT_EQ(RayCaster().cast({0, 0}, {1, 0}, 12.0), 12.0);
  EXPECT_TRUE(RayCaster().sees({0, 0}, {5, 5}));
}

TEST(RayCaster, WallsAndTrunksAtKnownDistances) {
  const RayCaster caster({{{4, -1}, {4, 1}}, {{-3, -3}, {3, -3}}}, {{{0, 6}, 1.0}});
  EXPECT_DOUBLE_EQ(caster.cast({0, 0}, {1, 0}, 50.0), 4.0);
  EXPECT_DOUBLE_EQ(caster.cast({0, 0}, {0, -1}, 50.0), 3.0);
  EXPECT_DOUBLE_EQ(caster.cast({0, 0}, {0, 1}, 50.0), 5.0);
  EXPECT_EQ(caster.cast({0, 0}, {-1, 0}, 50.0), 50.0);
  EXPECT_EQ(caster.cast({0, 0}, {1, 0}, 3.5), 3.5);
  EXPECT_NEAR(caster.cast({0, 0}, direction_of(std::atan2(1.0, 4.0) - 1e-9), 50.0), std::sqrt(17.0),
              1e-6);
  EXPECT_EQ(caster.cast({0, 0}, direction_of(std::atan2(1.0, 4.0) + 1e-9), 50.0), 50.0);
}

TEST(RayCaster, SeesPastWhatIsNotBetween) {
  const RayCaster caster({{{4, -1}, {4, 1}}}, {});
  EXPECT_FALSE(caster.sees({0, 0}, {5, 0}));
  EXPECT_TRUE(caster.sees({0, 0}, {3, 0}));
  EXPECT_TRUE(caster.sees({0, 0}, {5, 2}));
  EXPECT_TRUE(caster.sees({0, 0}, {4, 0})) << "a point on the wall itself";
  EXPECT_TRUE(caster.sees({1, 1}, {1, 1}));
}

/// The nearest of all shapes, one caster each: nothing of a grid is shared.
double cast_one_by_one(const std::vector<Wall>& walls, const std::vector<Trunk>& trunks,
                       const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                       double range) {
  double nearest = range;
  for (const Wall& wall : walls)
    nearest = std::min(nearest, RayCaster({wall}, {}).cast(origin, direction, range));
  for (const Trunk& trunk : trunks)
    nearest = std::min(nearest, RayCaster({}, {trunk}).cast(origin, direction, range));
  return nearest;
}

TEST(RayCaster, GridFindsWhatTestingEveryShapeFinds) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-20.0, 20.0), size(0.05, 2.0), angle(-4.0, 4.0);
  for (int world = 0; world < 10; ++world) {
    std::vector<Wall> walls;
    std::vector<Trunk> trunks;
    for (int i = 0; i < 10 + 20 * world; ++i) {
      const Eigen::Vector2d p(place(random), place(random));
      walls.push_back({p, p + 3.0 * size(random) * direction_of(angle(random))});
      trunks.push_back({{place(random), place(random)}, size(random) / 4});
    }
    const RayCaster caster(walls, trunks);
    int hits = 0;
    for (int ray = 0; ray < 200; ++ray) {
      const Eigen::Vector2d origin(1.4 * place(random), 1.4 * place(random));
      const Eigen::Vector2d direction =
          ray % 4 == 0 ? Eigen::Vector2d(ray % 8 == 0 ? 1 : -1, 0) : direction_of(angle(random));
      const double found = caster.cast(origin, direction, 30.0);
      hits += found < 30.0 ? 1 : 0;
      EXPECT_NEAR(found, cast_one_by_one(walls, trunks, origin, direction, 30.0), 1e-9);
    }
    EXPECT_GT(hits, 20);
  }
}

TEST(RayCaster, ClosedRoomHasNoHoles) {
  const std::vector<Wall> room = {
      {{0, 0}, {6, 0}}, {{6, 0}, {6, 5}}, {{6, 5}, {0, 5}}, {{0, 5}, {0, 0}}};
  const RayCaster caster(room, {});
  for (int i = 0; i < 3600; ++i) {
    const Eigen::Vector2d d = direction_of((i + 0.25) * M_PI / 1800.0);
    const double x = d.x() > 0 ? 4.0 / d.x() : -2.0 / d.x();
    const double y = d.y() > 0 ? 2.0 / d.y() : -3.0 / d.y();
    EXPECT_NEAR(caster.cast({2, 3}, d, 100.0), std::min(x, y), 1e-9) << i;
  }
  for (const Wall& wall : room) {
    const Eigen::Vector2d to_corner = wall.from - Eigen::Vector2d(2, 3);
    EXPECT_NEAR(caster.cast({2, 3}, to_corner.normalized(), 100.0), to_corner.norm(), 1e-9);
  }
}

}  // namespace
}  // namespace libslam
