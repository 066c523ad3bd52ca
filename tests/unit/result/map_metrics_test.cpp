#include <cmath>

#include <gtest/gtest.h>

#include <libslam/result/metrics.hpp>

namespace libslam {
namespace {

using mrpt::math::TPose2D;

LandmarkEstimate landmark(std::int64_t id, double x, double y, const std::string& type = "point") {
  return {id, type, Eigen::Vector2d(x, y), Eigen::Matrix2d::Identity(), 1};
}

const std::vector<TrueLandmark> kTruth = {{1, Eigen::Vector2d(0, 0)},
                                          {2, Eigen::Vector2d(10, 0)},
                                          {3, Eigen::Vector3d(10, 10, 1)},
                                          {4, Eigen::Vector2d(0, 10)}};

TEST(MapErrors, ByIdentityUnderThePlacementOfThePath) {
  // The filter's frame is the true one moved by (1, 0); landmark 2 is 0.3 m off, 9 does not exist,
  // 4 is missing.
  const LandmarkMap map(
      {landmark(1, -1, 0), landmark(2, 9, 0.3), landmark(3, 9, 10), landmark(9, 0, 0)});
  const auto errors = compare_map(map, kTruth, LandmarkIdentity::known, TPose2D(1, 0, 0), true);
  ASSERT_TRUE(errors && errors->rmse_m && errors->rmse_aligned_m);
  EXPECT_EQ(errors->matched, 3);
  EXPECT_EQ(errors->missed, 1);
  EXPECT_EQ(errors->duplicates, 1);
  EXPECT_NEAR(*errors->rmse_m, 0.3 / std::sqrt(3), 1e-12);
  EXPECT_LT(*errors->rmse_aligned_m, *errors->rmse_m);
}

TEST(MapErrors, ARigidlyMovedMapHasNoAlignedError) {
  LandmarkMap map;
  const TPose2D T(3, -2, 1.1);
  for (const TrueLandmark& real : kTruth) {
    const Eigen::Vector2d p = transform_point(T, real.position.head<2>());
    map.add(landmark(real.id, p.x(), p.y()));
  }
  const auto errors = compare_map(map, kTruth, LandmarkIdentity::known, std::nullopt, false);
  EXPECT_FALSE(errors->rmse_m);
  EXPECT_LT(*errors->rmse_aligned_m, 1e-12);
}

TEST(MapErrors, WithoutIdentityMutualNeighboursMatchAndDuplicatesCount) {
  // Ids mean nothing; (10.4, 0) is a second copy of (10, 0), nobody is near (0, 10).
  const LandmarkMap map(
      {landmark(77, 10.1, 0), landmark(1, 10.4, 0), landmark(5, 0, 0.1), landmark(6, 10, 10.1)});
  const auto errors = compare_map(map, kTruth, LandmarkIdentity::unknown, TPose2D(0, 0, 0), true);
  EXPECT_EQ(errors->matched, 3);
  EXPECT_EQ(errors->missed, 1);
  EXPECT_EQ(errors->duplicates, 1);
  EXPECT_NEAR(*errors->rmse_m, 0.1, 1e-12);
}

TEST(MapErrors, NothingToCompare) {
  const LandmarkMap lines({landmark(1, 0, 0, "line")});
  EXPECT_FALSE(compare_map(lines, kTruth, LandmarkIdentity::known, TPose2D(0, 0, 0), true));
  EXPECT_FALSE(compare_map(LandmarkMap({landmark(1, 0, 0)}), kTruth, LandmarkIdentity::unknown,
                           std::nullopt, false));
  const auto strangers = compare_map(LandmarkMap({landmark(50, 0, 0)}), kTruth,
                                     LandmarkIdentity::known, std::nullopt, false);
  EXPECT_EQ(strangers->matched, 0);
  EXPECT_EQ(strangers->missed, 4);
  EXPECT_FALSE(strangers->rmse_m || strangers->rmse_aligned_m);
}

}  // namespace
}  // namespace libslam
