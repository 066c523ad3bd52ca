// Filters that start in a map: given landmarks, known exactly or not, and what a map must fit.

#include <limits>
#include <tests/support/slam_world.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/association/nearest_neighbour.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/measurement/range_bearing.hpp>
#include <libslam/motion/differential.hpp>

using namespace libslam;
using libslam::testing::SlamWorld;

namespace {

EkfSlamParts parts_with(const char* frame, bool known, bool calibrated = false) {
  MotionParameters motion;
  motion.track_width = 0.5;
  CalibrationParameters calibration;
  calibration.scale_left.enabled = calibration.scale_right.enabled = calibrated;
  EkfSlamParts parts;
  parts.motion = std::make_unique<Differential>(motion, calibration);
  parts.measurement = std::make_unique<RangeBearing>();
  if (known)
    parts.associator = std::make_unique<KnownAssociation>(std::numeric_limits<double>::infinity());
  else
    parts.associator = std::make_unique<NearestNeighbour>(11.8, 40.0);
  parts.frame = make_error_frame(frame);
  return parts;
}

SavedMap survey_of(const SlamWorld& world, double sigma) {
  std::vector<TrueLandmark> landmarks;
  for (std::size_t i = 0; i < world.landmarks.size(); ++i)
    landmarks.push_back({static_cast<std::int64_t>(i), world.landmarks[i]});
  return surveyed_map(landmarks, sigma);
}

MapStart localize_in(SavedMap map, bool at_saved_pose = false) {
  MapStart start;
  start.map = std::make_shared<SavedMap>(std::move(map));
  start.landmarks_given = true;
  start.at_saved_pose = at_saved_pose;
  return start;
}

EkfSlam localized(const char* frame, bool known, double sigma) {
  std::mt19937_64 random(71);
  SlamWorld world;
  EkfSlamParts parts = parts_with(frame, known);
  parts.map = localize_in(survey_of(world, sigma));
  EkfSlam filter(std::move(parts));
  for (int k = 0; k < 200; ++k) {
    const MotionAction action = world.drive(random, 1.0);
    filter.propagate(&action);
    filter.update(world.observe(random, 1.0));
  }
  const Eigen::Vector3d pose = filter.state().estimate(filter.pose());
  // Five range-bearing pairs at 5 cm and 0.6 deg, and the map: a centimetre or so.
  EXPECT_LT((pose - world.pose).head<2>().norm(), 0.1 + 3.0 * sigma);
  return filter;
}

EkfSlam mapped(bool calibrated) {
  std::mt19937_64 random(72);
  SlamWorld world;
  EkfSlam filter(parts_with("right_invariant", true, calibrated));
  for (int k = 0; k < 100; ++k) {
    const MotionAction action = world.drive(random, 1.0);
    filter.propagate(&action);
    filter.update(world.observe(random, 1.0));
  }
  return filter;
}

}  // namespace

TEST(MapStart, ExactLandmarksTakeNoRoomAndSayTheSameAsZeroVariances) {
  for (const char* frame : {"standard", "right_invariant"}) {
    const EkfSlam exact = localized(frame, true, 0.0);
    EXPECT_EQ(exact.state().dimension(), 3);
    EXPECT_EQ(exact.registry().size(), 36u);
    // Variances of 1e-24 m^2 are none beside 1e-4: the difference is rounding.
    const EkfSlam nearly = localized(frame, true, 1e-12);
    EXPECT_EQ(nearly.state().dimension(), 3 + 2 * 36);
    EXPECT_LT(
        (exact.state().estimate(exact.pose()) - nearly.state().estimate(nearly.pose())).norm(),
        1e-9);
    EXPECT_LT(
        (exact.state().covariance_of(exact.pose()) - nearly.state().covariance_of(nearly.pose()))
            .norm(),
        1e-12);
  }
}

TEST(MapStart, GivenLandmarksStayBitForBitAndTheirUncertaintyCounts) {
  const SlamWorld world;
  const SavedMap map = survey_of(world, 0.2);
  for (const char* frame : {"standard", "right_invariant"})
    for (const bool known : {true, false}) {
      const EkfSlam filter = localized(frame, known, 0.2);
      const auto landmarks = filter.landmarks();
      ASSERT_EQ(landmarks.size(), world.landmarks.size());
      for (std::size_t i = 0; i < landmarks.size(); ++i)
        EXPECT_EQ(landmarks[i].mean, Eigen::VectorXd(world.landmarks[i]));
      const Eigen::MatrixXd cov = filter.state().full_covariance();
      EXPECT_EQ(cov.bottomRightCorner(72, 72), map.cov);
      // Landmarks of 0.2 m that are not averaged away leave centimetres, exact ones millimetres.
      EXPECT_GT(filter.state().covariance_of(filter.pose())(0, 0), 0.03 * 0.03);
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(cov).eigenvalues().minCoeff(), 0.0);
    }
}

TEST(MapStart, LocalizationAddsNoLandmarks) {
  std::mt19937_64 random(73);
  SlamWorld world;
  SavedMap map = survey_of(world, 0.0);
  map.landmarks.resize(20);
  EkfSlamParts parts = parts_with("right_invariant", true);
  parts.map = localize_in(map);
  EkfSlam filter(std::move(parts));
  int unused = 0;
  for (int k = 0; k < 100; ++k) {
    const MotionAction action = world.drive(random, 1.0);
    filter.propagate(&action);
    const UpdateOutcome outcome = filter.update(world.observe(random, 1.0));
    EXPECT_EQ(outcome.new_landmarks, 0);
    unused += outcome.ambiguous;
  }
  EXPECT_GT(unused, 0);
  EXPECT_EQ(filter.registry().size(), 20u);
}

TEST(MapStart, SlamGoesOnAroundExactLandmarks) {
  std::mt19937_64 random(74);
  SlamWorld world;
  SavedMap map = survey_of(world, 0.0);
  map.landmarks.resize(3);
  EkfSlamParts parts = parts_with("right_invariant", true);
  parts.map = localize_in(map);
  parts.map->landmarks_given = false;
  EkfSlam filter(std::move(parts));
  for (int k = 0; k < 150; ++k) {
    const MotionAction action = world.drive(random, 1.0);
    filter.propagate(&action);
    filter.update(world.observe(random, 1.0));
  }
  EXPECT_GT(filter.registry().size(), 12u);
  EXPECT_EQ(filter.landmarks()[2].mean, Eigen::VectorXd(world.landmarks[2]));
  const SavedMap saved = filter.saved_map();
  EXPECT_TRUE(saved.landmarks[2].exact);
  EXPECT_NO_THROW(check_saved_map(saved));
}

TEST(MapStart, AGivenPoseIsIndependentOfTheMap) {
  const EkfSlam before = mapped(false);
  EkfSlamParts parts = parts_with("right_invariant", true);
  parts.map = localize_in(before.saved_map());
  parts.start = Eigen::Vector3d(1.0, 2.0, 0.5);
  parts.cov_start = 0.04 * Eigen::Matrix3d::Identity();
  const EkfSlam filter(std::move(parts));
  EXPECT_EQ(filter.state().estimate(filter.pose()),
            Eigen::VectorXd(Eigen::Vector3d(1.0, 2.0, 0.5)));
  const Eigen::MatrixXd cov = filter.state().full_covariance();
  EXPECT_EQ(cov.topLeftCorner(3, 3), Eigen::MatrixXd(0.04 * Eigen::Matrix3d::Identity()));
  EXPECT_EQ(cov.topRightCorner(3, cov.cols() - 3).norm(), 0.0);
  const Eigen::MatrixXd old = before.state().full_covariance();
  const Eigen::Index n = cov.rows() - 3;
  EXPECT_EQ(cov.bottomRightCorner(n, n), old.bottomRightCorner(n, n));
}

TEST(MapStart, CalibrationComesByName) {
  const EkfSlam before = mapped(true);
  const auto start = [&](bool calibrated, bool saved) {
    EkfSlamParts parts = parts_with("right_invariant", true, calibrated);
    parts.map = localize_in(before.saved_map(), true);
    parts.map->saved_calibration = saved;
    return EkfSlam(std::move(parts));
  };
  const EkfSlam same = start(true, true), anew = start(true, false), none = start(false, true);
  EXPECT_EQ(same.calibration()[0].mean, before.calibration()[0].mean);
  EXPECT_EQ(same.state().full_covariance(), before.state().full_covariance());
  EXPECT_EQ(anew.calibration()[0].mean, anew.calibration()[0].prior_mean);
  EXPECT_EQ(anew.calibration()[0].sigma, anew.calibration()[0].prior_sigma);
  EXPECT_TRUE(none.calibration().empty());
  // What is left out is marginalized out: the others keep their covariance.
  EXPECT_EQ(none.state().covariance_of(none.pose()), before.state().covariance_of(before.pose()));
}

TEST(MapStart, TheAppearanceOfALandmarkIsKept) {
  SavedMap map = survey_of(SlamWorld(), 0.1);
  Descriptor descriptor;
  descriptor.size = 32;
  descriptor.bytes[7] = 0x5a;
  map.landmarks[3].appearance = std::make_shared<Descriptor>(descriptor);
  EkfSlamParts parts = parts_with("standard", true);
  parts.map = localize_in(map);
  const SavedMap saved = EkfSlam(std::move(parts)).saved_map();
  EXPECT_EQ(saved.landmarks[2].appearance, nullptr);
  ASSERT_NE(saved.landmarks[3].appearance, nullptr);
  EXPECT_EQ(saved.landmarks[3].appearance->bytes, descriptor.bytes);
}

TEST(MapStart, AProvisionalLandmarkIsNotGiven) {
  SavedMap map = survey_of(SlamWorld(), 0.1);
  map.landmarks[4].confirmed = false;
  EkfSlamParts parts = parts_with("standard", true);
  parts.map = localize_in(map);
  EXPECT_EQ(EkfSlam(std::move(parts)).registry().size(), 35u);
}

TEST(MapStart, WhatDoesNotFitIsRefused) {
  const auto attempt = [](auto change) {
    EkfSlamParts parts = parts_with("standard", true);
    SavedMap map = survey_of(SlamWorld(), 0.1);
    parts.map = localize_in(map);
    change(parts, map);
    parts.map->map = std::make_shared<SavedMap>(map);
    EkfSlam filter(std::move(parts));
  };
  EXPECT_NO_THROW(attempt([](EkfSlamParts&, SavedMap&) {}));
  EXPECT_THROW(attempt([](EkfSlamParts&, SavedMap& map) {
                 map = surveyed_map({{1, Eigen::Vector3d(1, 2, 3)}}, 0.0);
               }),
               std::invalid_argument);
  EXPECT_THROW(attempt([](EkfSlamParts& parts, SavedMap&) { parts.map->at_saved_pose = true; }),
               std::invalid_argument);
  EXPECT_THROW(attempt([](EkfSlamParts&, SavedMap& map) { map.landmarks[1].type = "line"; }),
               std::invalid_argument);
  EXPECT_THROW(attempt([](EkfSlamParts& parts, SavedMap&) {
                 parts.linearization = std::make_unique<FirstEstimates>();
               }),
               std::invalid_argument);
}
