#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stereo_fixture.hpp"

namespace libslam {
namespace {

using namespace libslam::testing;

/// Detector and tracker.
using Tracker = std::pair<std::string, std::string>;

class EveryTracker : public ::testing::TestWithParam<Tracker> {
 protected:
  FrontendParameters parameters() const {
    return stereo_parameters(GetParam().first, GetParam().second);
  }
};

TEST_P(EveryTracker, MeasuresDisparityToAFractionOfAPixel) {
  for (const double disparity : {6.5, 17.37, 40.0, 63.81}) {
    StereoFeatures frontend(parameters(), "", true);
    const FeatureBatch batch = features_of(frontend, wall_at(disparity));
    ASSERT_GT(batch.size(), 60U) << disparity;
    double sum = 0.0, squares = 0.0;
    std::set<std::int64_t> ids;
    for (const Feature& feature : batch) {
      const double error = feature.z[2] - disparity;
      sum += error;
      squares += error * error;
      ids.insert(feature.id);
      EXPECT_NE(feature.appearance, nullptr);
    }
    const auto n = static_cast<double>(batch.size());
    // Rounding to whole gray values alone leaves a few hundredths of a pixel.
    EXPECT_LT(std::abs(sum / n), 0.03) << disparity;
    EXPECT_LT(std::sqrt(squares / n), 0.15) << disparity;
    EXPECT_EQ(ids.size(), batch.size());
    EXPECT_LT(frontend.figures().at("mean_row_error_px"), 0.1);
    EXPECT_TRUE(frontend.warnings().empty());
  }
}

TEST_P(EveryTracker, FollowsPointsAndKeepsTheirIdentity) {
  const Texture texture(3);
  StereoFeatures frontend(parameters(), "", true);
  std::map<std::int64_t, Eigen::Vector2d> seen;  // on the wall
  constexpr double kStep = 4.3, kDisparity = 20.4;
  std::size_t continued = 0;
  for (int k = 0; k < 4; ++k) {  // the camera moves to the right along a wall
    const auto pair = pair_of([&](int x, int y) { return texture(x + kStep * k, y); },
                              [&](int x, int y) { return texture(x + kStep * k + kDisparity, y); });
    for (const Feature& feature : features_of(frontend, pair)) {
      const Eigen::Vector2d on_wall(feature.z[0] + kStep * k, feature.z[1]);
      const auto [before, is_new] = seen.emplace(feature.id, on_wall);
      if (is_new) continue;
      ++continued;
      // Both places have the noise of the feature; a coarse scale has more of it.
      const Eigen::Matrix2d cov = 2.0 * feature.cov.topLeftCorner<2, 2>();
      const Eigen::Vector2d moved = on_wall - before->second;
      EXPECT_LT(moved.dot(cov.inverse() * moved), 25.0) << moved.transpose();
    }
  }
  EXPECT_GT(continued, 150U);
}

TEST_P(EveryTracker, SameBytesForAnyNumberOfThreads) {
  const auto run = [&](int threads) {
    cv::setNumThreads(threads);
    StereoFeatures frontend(parameters(), "", true);
    std::vector<double> numbers;
    for (int k = 0; k < 3; ++k) {
      for (const Feature& feature : features_of(frontend, wall_at(15.2 + k, 5))) {
        numbers.push_back(static_cast<double>(feature.id));
        numbers.insert(numbers.end(), feature.z.begin(), feature.z.end());
      }
    }
    return numbers;
  };
  const auto one = run(1), two = run(2), again = run(2);
  cv::setNumThreads(-1);
  ASSERT_FALSE(one.empty());
  EXPECT_EQ(one, two);
  EXPECT_EQ(two, again);
}

INSTANTIATE_TEST_SUITE_P(Stereo, EveryTracker,
                         ::testing::Values(Tracker("orb", "descriptors"),
                                           Tracker("akaze", "descriptors"),
                                           Tracker("sift", "descriptors"), Tracker("orb", "klt")),
                         [](const auto& of) { return of.param.first + "_" + of.param.second; });

TEST(StereoFeatures, CameraAndCovarianceAreThoseOfTheObservation) {
  const auto pair = wall_at(25.0);
  const mrpt::poses::CPose3D pose(0.3, 0.1, 0.9, -kPi / 2, 0.0, -kPi / 2);
  pair->cameraPose = mrpt::poses::CPose3DQuat(pose);
  FrontendParameters p = stereo_parameters("orb", "klt");
  p.stereo.sigma_pixel = 0.4;
  StereoFeatures frontend(p, "stereo", true);
  const FeatureBatch batch = features_of(frontend, pair);
  ASSERT_FALSE(batch.empty());
  const StereoCamera& camera = *batch.front().camera;
  EXPECT_EQ(camera.fx, kFocal);
  EXPECT_NEAR(camera.baseline, kBaseline, 1e-12);
  // A point ahead of the camera is ahead of the robot.
  const Eigen::Vector3d p_robot = camera.T_robot_camera * Eigen::Vector3d(0.0, 0.0, 2.0);
  EXPECT_TRUE(p_robot.isApprox(Eigen::Vector3d(2.3, 0.1, 0.9), 1e-12)) << p_robot.transpose();
  Eigen::Matrix3d expected;
  expected << 1.0, 0.0, 1.0, 0.0, 0.5, 0.0, 1.0, 0.0, 2.0;
  EXPECT_TRUE(Eigen::Matrix3d(batch.front().cov).isApprox(0.16 * expected, 1e-12));
}

TEST(StereoFeatures, BudgetIsKeptAndSpread) {
  FrontendParameters p = stereo_parameters();
  p.stereo.delivered = 40;
  StereoFeatures frontend(p, "", false);
  const FeatureBatch batch = features_of(frontend, wall_at(8.0));
  ASSERT_EQ(batch.size(), 40U);
  std::set<int> quarters;
  for (const Feature& feature : batch) {
    EXPECT_EQ(feature.id, kNoIdentity);
    quarters.insert((feature.z[0] < kWidth / 2 ? 0 : 1) + (feature.z[1] < kHeight / 2 ? 0 : 2));
  }
  EXPECT_EQ(quarters.size(), 4U);
}

TEST(StereoFeatures, FarPointsAreNoPoints) {
  StereoFeatures frontend(stereo_parameters(), "", true);
  // 3 sigma_d = 3 sqrt(2) 0.5 px = 2.12 px
  EXPECT_TRUE(features_of(frontend, wall_at(1.6)).empty());
  // The right partner lies where no search looks; of 400 points 1 in 20 finds a double at most
  // (measured: 14).
  StereoFeatures behind(stereo_parameters(), "", true);
  EXPECT_LE(features_of(behind, wall_at(-4.0)).size(), 20U);
}

/// Before a wall stands a board, x from 140 to 200 px in the left image.
constexpr int kBoardLeft = 140, kBoardRight = 200;
constexpr double kWall = 10.0, kBoard = 40.0;

mrpt::obs::CObservationStereoImages::Ptr board_before_wall(double moved = 0.0) {
  const Texture wall(7), board(8);
  const auto on_board = [moved](double x) {
    return x >= kBoardLeft + moved && x < kBoardRight + moved;
  };
  return pair_of(
      [&, moved](int x, int y) { return on_board(x) ? board(x - moved, y) : wall(x, y); },
      [&, moved](int x, int y) {
        return on_board(x + kBoard) ? board(x + kBoard - moved, y) : wall(x + kWall, y);
      });
}

TEST_P(EveryTracker, WhatOnlyOneCameraSeesIsNoPoint) {
  StereoFeatures frontend(parameters(), "", true);
  const FeatureBatch batch = features_of(frontend, board_before_wall());
  ASSERT_GT(batch.size(), 60U);
  int hidden = 0;
  for (const Feature& feature : batch) {
    // The board hides this strip of the wall from the right camera; windows reach 6 px beyond.
    if (feature.z[0] > kBoardLeft - (kBoard - kWall) + 6.0 && feature.z[0] < kBoardLeft - 6.0)
      ++hidden;
  }
  EXPECT_LE(hidden, 2) << "of " << batch.size();
}

/// The same with a second, larger board at the left border that stands still. Without it the board
/// that moves would be no contradiction: a camera that shifts and turns sees the far wall at rest.
mrpt::obs::CObservationStereoImages::Ptr moving_board(double moved) {
  const Texture wall(7), board(8), still(9);
  const auto on_board = [moved](double x) {
    return x >= kBoardLeft + moved && x < kBoardRight + moved;
  };
  const auto on_still = [](double x) { return x < 120.0; };
  return pair_of(
      [&, moved](int x, int y) {
        return on_board(x) ? board(x - moved, y) : on_still(x) ? still(x, y) : wall(x, y);
      },
      [&, moved](int x, int y) {
        const double near = x + kBoard;
        return on_board(near)   ? board(near - moved, y)
               : on_still(near) ? still(near, y)
                                : wall(x + kWall, y);
      });
}

TEST_P(EveryTracker, WhatMovesByItselfIsNotDelivered) {
  StereoFeatures frontend(parameters(), "", true);
  int inside = 0, total = 0;
  for (int k = 0; k < 5; ++k) {
    const double moved = 6.0 * k;
    const FeatureBatch batch = features_of(frontend, moving_board(moved));
    if (k == 0) continue;  // nothing to check by
    for (const Feature& feature : batch) {
      const double x = feature.z[0] - moved;
      inside += x > kBoardLeft + 7.0 && x < kBoardRight - 7.0 ? 1 : 0;
      ++total;
    }
  }
  EXPECT_GT(total, 200);
  // Points of a coarse scale are placed to 2.5 px at best and may pass for standing still.
  EXPECT_LE(inside, total / 50) << "of " << total;
}

TEST(StereoFeatures, ReportsRowErrorOfAWrongCalibration) {
  StereoFeatures frontend(stereo_parameters(), "", true);
  features_of(frontend, wall_at(20.0, 1, 1.2));
  EXPECT_NEAR(frontend.figures().at("mean_row_error_px"), 1.2, 0.1);
  ASSERT_EQ(frontend.warnings().size(), 1U);
  EXPECT_NE(frontend.warnings()[0].find("1.2"), std::string::npos) << frontend.warnings()[0];
  StereoFeatures lost(stereo_parameters(), "", true);
  EXPECT_LE(features_of(lost, wall_at(20.0, 1, 6.0)).size(), 4U);
}

TEST(StereoFeatures, BadInputIsCountedAndNamed) {
  const auto defect_of =
      [](const std::function<void(mrpt::obs::CObservationStereoImages&)>& spoil) {
        StereoFeatures frontend(stereo_parameters(), "", true);
        const auto pair = wall_at(20.0);
        spoil(*pair);
        EXPECT_TRUE(features_of(frontend, pair).empty());
        EXPECT_EQ(frontend.unusable(), 1);
        EXPECT_EQ(frontend.warnings().size(), 1U);
        return frontend.warnings().empty() ? "" : frontend.warnings().front();
      };
  const auto expect = [&](const char* words, auto spoil) {
    const std::string defect = defect_of(spoil);
    EXPECT_NE(defect.find(words), std::string::npos) << defect;
    EXPECT_EQ(defect.find('\n'), std::string::npos) << defect;
  };
  using Pair = mrpt::obs::CObservationStereoImages;
  expect("without right image", [](Pair& p) { p.hasImageRight = false; });
  expect("right image: cannot be read", [](Pair& p) { p.imageRight = mrpt::img::CImage(); });
  expect("another size",
         [](Pair& p) { p.imageRight = image_of([](int, int) { return 0.0; }, 100, 100); });
  expect("folder of the images is missing: /nowhere",
         [](Pair& p) { p.imageLeft.setExternalStorage("/nowhere/left.png"); });
  expect("baseline -0.2", [](Pair& p) {
    p.rightCameraPose = mrpt::poses::CPose3DQuat(mrpt::poses::CPose3D(-0.2, 0, 0, 0, 0, 0));
  });
  expect("not finite", [](Pair& p) { p.leftCamera.cx(std::nan("")); });
  expect("focal length", [](Pair& p) { p.rightCamera.fx(0.0); });
  expect("fish-eye",
         [](Pair& p) { p.leftCamera.distortion = mrpt::img::DistortionModel::kannala_brandt; });
}

// ORB works on copies smaller by up to 1.2^7 and reads a border of 31 pixels without asking.
TEST(StereoFeatures, ImagesSmallerThanAWindowAreRefused) {
  const Texture texture(1);
  const auto pair_of_size = [&](int width, int height) {
    const auto pair = wall_at(6.0);
    pair->imageLeft = image_of([&](int x, int y) { return texture(x, y); }, width, height);
    pair->imageRight = image_of([&](int x, int y) { return texture(x + 6, y); }, width, height);
    return pair;
  };
  for (const char* detector : {"orb", "akaze", "sift"})
    for (const char* tracker : {"descriptors", "klt"}) {
      StereoFeatures frontend(stereo_parameters(detector, tracker), "", true);
      std::int64_t refused = 0;
      for (const auto& [width, height] : {std::pair(1, 1), {2, 300}, {12, 12}, {300, 63}}) {
        EXPECT_TRUE(features_of(frontend, pair_of_size(width, height)).empty());
        EXPECT_EQ(frontend.unusable(), ++refused) << width << " x " << height;
        EXPECT_NE(frontend.warnings().back().find("64 x 64"), std::string::npos);
      }
      for (int k = 0; k < 2; ++k) features_of(frontend, pair_of_size(64, 64));  // the smallest
      EXPECT_EQ(frontend.unusable(), refused) << detector << ' ' << tracker;
      EXPECT_FALSE(features_of(frontend, wall_at(20.0)).empty());
    }
}

TEST(StereoFeatures, BlankImagesGiveNothingAndEndTheTracks) {
  for (const char* tracker : {"descriptors", "klt"}) {
    StereoFeatures frontend(stereo_parameters("orb", tracker), "", true);
    EXPECT_FALSE(features_of(frontend, wall_at(20.0)).empty());
    const auto blank = pair_of([](int, int) { return 90.0; }, [](int, int) { return 90.0; });
    EXPECT_TRUE(features_of(frontend, blank).empty());
    EXPECT_FALSE(features_of(frontend, wall_at(20.0)).empty());
    EXPECT_EQ(frontend.unusable(), 0);
  }
}

TEST(StereoFeatures, RefusesUnknownNames) {
  EXPECT_THROW(StereoFeatures(stereo_parameters("surf"), "", true), std::invalid_argument);
  EXPECT_THROW(StereoFeatures(stereo_parameters("orb", "magic"), "", true), std::invalid_argument);
}

}  // namespace
}  // namespace libslam
