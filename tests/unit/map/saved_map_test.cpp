#include <limits>
#include <random>
#include <tests/support/random_matrix.hpp>

#include <gtest/gtest.h>

#include <libslam/map/saved_map.hpp>

using namespace libslam;
using libslam::testing::random_covariance;

namespace {

SavedMap sound_map() {
  std::mt19937_64 random(91);
  SavedMap map;
  map.pose = Eigen::Vector3d(1, 2, 0.3);
  map.calibration = {{"scale_left", 1.02}};
  for (int i = 0; i < 3; ++i) {
    SavedLandmark& landmark = map.landmarks.emplace_back();
    landmark.id = 10 + i;
    landmark.mean = Eigen::Vector2d(i, -i);
  }
  map.landmarks[1].exact = true;
  map.cov = random_covariance(8, random);
  return map;
}

template <class Change>
void expect_rejected(Change change, const std::string& text) {
  SavedMap map = sound_map();
  change(map);
  try {
    check_saved_map(map);
    FAIL() << text;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

}  // namespace

TEST(SavedMap, KnowsItsRows) {
  const SavedMap map = sound_map();
  EXPECT_EQ(map.pose_tangent(), 3);
  EXPECT_EQ(map.landmark_offset(), 4);
  EXPECT_EQ(map.tangent(), 8);
  EXPECT_NO_THROW(check_saved_map(map));
  SavedMap space;
  space.dimension = 3;
  space.pose = BlockVector::Unit(7, 6);
  EXPECT_EQ(space.pose_tangent(), 6);
  space.cov = Eigen::MatrixXd::Zero(6, 6);
  EXPECT_NO_THROW(check_saved_map(space));
}

TEST(SavedMap, WhatCannotBeIsRejectedByName) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  expect_rejected([](SavedMap& m) { m.dimension = 4; }, "2 or 3");
  expect_rejected([](SavedMap& m) { m.pose.resize(2); }, "3 or 7");
  expect_rejected([](SavedMap& m) { m.pose[1] = kNan; }, "pose is not finite");
  expect_rejected([](SavedMap& m) { m.landmarks[2].mean[0] = kNan; }, "landmark 12");
  expect_rejected([](SavedMap& m) { m.landmarks[2].mean.resize(3); }, "coordinates");
  expect_rejected([](SavedMap& m) { m.landmarks[2].id = 10; }, "comes twice");
  expect_rejected([](SavedMap& m) { m.landmarks[2].id = -1; }, "negative");
  expect_rejected([](SavedMap& m) { m.landmarks[0].type = "a,b"; }, "plain word");
  expect_rejected([](SavedMap& m) { m.landmarks[0].times_seen = -1; }, "negative");
  expect_rejected([](SavedMap& m) { m.calibration[0].name = ""; }, "name");
  expect_rejected([](SavedMap& m) { m.calibration[0].mean = kNan; }, "scale_left");
  expect_rejected([](SavedMap& m) { m.excitation = {kNan}; }, "excitation");
  expect_rejected([](SavedMap& m) { m.landmarks[1].exact = false; }, "8 x 8");
  expect_rejected([](SavedMap& m) { m.cov(3, 3) = kNan; }, "not finite");
  expect_rejected([](SavedMap& m) { m.cov(3, 3) = -1e-12; }, "negative");
  expect_rejected([](SavedMap& m) { m.cov(3, 4) *= 1.1; }, "symmetric");
  expect_rejected([](SavedMap& m) { m.cov(5, 3) = m.cov(3, 5) = 1e3; }, "correlation");
}

// Three correlations of -0.9 are possible in pairs and not together.
TEST(SavedMap, AnIndefiniteCovarianceIsRejectedAndASingularOneIsNot) {
  const auto indefinite = [](SavedMap& m) {
    m.cov.setIdentity();
    for (const auto& [i, j] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 2)})
      m.cov(i, j) = m.cov(j, i) = -0.9;
  };
  expect_rejected(indefinite, "semi-definite");
  SavedMap map = sound_map();
  map.cov.setOnes();
  EXPECT_NO_THROW(check_saved_map(map));
  map.cov.setZero();
  EXPECT_NO_THROW(check_saved_map(map));
}

TEST(SavedMap, ASurveyIsExactOrIndependent) {
  const std::vector<TrueLandmark> places = {{7, Eigen::Vector2d(1, 2)}, {3, Eigen::Vector2d(3, 4)}};
  const SavedMap exact = surveyed_map(places, 0.0);
  EXPECT_EQ(exact.cov.rows(), 0);
  EXPECT_TRUE(exact.landmarks[1].exact);
  EXPECT_EQ(exact.landmarks[1].id, 3);
  EXPECT_EQ(exact.next_number, 8);
  const SavedMap measured = surveyed_map(places, 0.5);
  EXPECT_EQ(measured.cov, 0.25 * Eigen::MatrixXd::Identity(4, 4));
  EXPECT_THROW(surveyed_map({places[0], {4, Eigen::Vector3d(1, 2, 3)}}, 0.0),
               std::invalid_argument);
}
