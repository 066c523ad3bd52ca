#include <numbers>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/filter/landmark_merging.hpp>
#include <libslam/measurement/line.hpp>
#include <libslam/state/chi_square.hpp>

using namespace libslam;

namespace {

constexpr double kPi = std::numbers::pi;

/// Lines of a map, independent of each other, with errors of 1 cm and .01 rad at their `place`
/// along the line.
class Map {
 public:
  Map() {
    pose_ = state.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, Eigen::Vector3d(1, 2, 0.5),
                      1e-4 * Eigen::Matrix3d::Identity());
  }
  void add(double alpha, double r, const Extent& extent, int sightings = 1, double place = 0.0) {
    Eigen::Matrix2d to_foot;
    to_foot << 1.0, 0.0, place, 1.0;
    const BlockId block =
        state.add({"", Chart::kLine, 2, WorldRole::kLine}, Eigen::Vector2d(alpha, r),
                  1e-4 * to_foot * to_foot.transpose());
    registry.add(block, kNoIdentity, nullptr, extent);
    while (--sightings > 0) registry.record_sighting(registry.size() - 1);
  }
  int merge(const MergingOptions& options = {1, chi_square_quantile(0.99, 2), 0.6}) {
    LandmarkMerging merging(options);
    return merging.update(state, ekf_, pose_, model_, registry);
  }
  Eigen::Vector2d line(std::size_t i) const {
    return state.estimate(registry.landmarks()[i].block);
  }

  GaussianState state;
  LandmarkRegistry registry{1, 0};

 private:
  Ekf ekf_{make_error_frame("right_invariant")};
  LineMeasurement model_;
  BlockId pose_;
};

}  // namespace

TEST(LandmarkMerging, TwoLinesOfOneWallBecomeOne) {
  Map map;
  map.add(0.500, 5.00, {-2.0, 1.0, 0.1, 0.1}, 3);
  map.add(0.505, 5.01, {0.5, 4.0, 0.1, 0.2}, 2);
  EXPECT_EQ(map.merge(), 1);
  ASSERT_EQ(map.registry.size(), 1u);
  const RegisteredLandmark& wall = map.registry.landmarks()[0];
  EXPECT_EQ(wall.id, 0);
  EXPECT_EQ(wall.times_seen, 5);
  EXPECT_NEAR(wall.extent->begin, -2.0, 1e-12);
  EXPECT_NEAR(wall.extent->end, 4.0, 0.05);
  EXPECT_EQ(wall.extent->sigma_end, 0.2);
  EXPECT_EQ(map.state.blocks().size(), 2u);
  EXPECT_GT(map.line(0)[0], 0.500);
  EXPECT_LT(map.line(0)[0], 0.505);
  EXPECT_LT(map.state.covariance_of(wall.block)(0, 0), 1e-4);
}

TEST(LandmarkMerging, TheOneSeenMoreOftenStays) {
  Map map;
  map.add(0.500, 5.00, {-2.0, 1.0, 0.1, 0.1}, 2);
  map.add(0.505, 5.01, {0.5, 4.0, 0.1, 0.2}, 3);
  EXPECT_EQ(map.merge(), 1);
  EXPECT_EQ(map.registry.landmarks()[0].id, 1);
}

TEST(LandmarkMerging, TheTwoSidesOfAWallStayTwo) {
  Map map;
  map.add(0.5, 5.0, {-2.0, 1.0, 0.1, 0.1});
  map.add(0.5 - kPi, -5.1, {-1.0, 2.0, 0.1, 0.1});
  EXPECT_EQ(map.merge(), 0);
  EXPECT_EQ(map.registry.size(), 2u);
}

TEST(LandmarkMerging, PartsFarApartStayTwo) {
  Map map;
  map.add(0.5, 5.0, {-2.0, 1.0, 0.1, 0.1});
  map.add(0.5, 5.0, {1.7, 4.0, 0.1, 0.1});
  EXPECT_EQ(map.merge(), 0);
  Map near;
  near.add(0.5, 5.0, {-2.0, 1.0, 0.1, 0.1});
  near.add(0.5, 5.0, {1.5, 4.0, 0.1, 0.1});
  EXPECT_EQ(near.merge(), 1);
}

TEST(LandmarkMerging, WallsBesideEachOtherStayTwo) {
  Map map;
  map.add(0.5, 5.0, {-2.0, 1.0, 0.1, 0.1});
  map.add(0.5, 5.3, {-2.0, 1.0, 0.1, 0.1});
  EXPECT_EQ(map.merge(), 0);
}

// Far from the origin a small turn moves r by much: what counts is how far apart they are where
// both were seen.
TEST(LandmarkMerging, LinesAreComparedWhereTheyWereSeen) {
  static constexpr double kPlace = 100.0;
  const auto through = [](double alpha) {  // r of a line through (5, kPlace)
    return 5.0 * std::cos(alpha) + kPlace * std::sin(alpha);
  };
  const Extent part{kPlace - 1, kPlace + 1, 0.1, 0.1};
  Map same, other;
  same.add(0.0, through(0.0), part, 1, kPlace);
  same.add(0.02, through(0.02), part, 1, kPlace);
  EXPECT_EQ(same.merge(), 1);
  other.add(0.0, 5.0, part, 1, kPlace);
  other.add(0.02, 5.0, part, 1, kPlace);  // 2 m beside it there
  EXPECT_EQ(other.merge(), 0);
}

TEST(LandmarkMerging, ThreePartsOfOneWallBecomeOneInOnePass) {
  Map map;
  map.add(3.1, 5.00, {-6.0, -3.0, 0.1, 0.1});
  map.add(3.1, 5.01, {1.0, 4.0, 0.1, 0.1});
  map.add(3.1, 5.00, {-3.0, 1.0, 0.1, 0.1});  // joins the two
  EXPECT_EQ(map.merge(), 2);
  EXPECT_EQ(map.registry.size(), 1u);
}

TEST(LandmarkMerging, APassIsDueEveryFewUpdatesAndForWhatWasSeenSince) {
  Map map;
  map.add(0.5, 5.0, {-2.0, 1.0, 0.1, 0.1});
  map.add(0.5, 5.0, {-2.0, 1.0, 0.1, 0.1});
  for (int i = 0; i < 3; ++i) map.registry.record_update();
  EXPECT_EQ(map.merge({2, 9.2, 0.6}), 0);  // its first update
  EXPECT_EQ(map.merge({1, 9.2, 0.6}), 0);  // nothing seen since the pass before
  map.registry.record_sighting(1);
  EXPECT_EQ(map.merge({1, 9.2, 0.6}), 1);
}
