#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>

#include <libslam/data/step_record.hpp>
#include <libslam/io/rawlog_player.hpp>
#include <libslam/modules/range_bearing_slam_2d.hpp>

#include "support/mrpt_pair.hpp"
#include "support/slam_world.hpp"
#include "support/temporary_directory.hpp"

namespace libslam {
namespace {

using mrpt::obs::CActionCollection;

/// Everything that getCurrentState() tells.
struct Snapshot {
  template <typename Slam>
  explicit Snapshot(const Slam& slam) {
    slam.getCurrentState(pose, landmarks, ids, mean, cov);
  }
  mrpt::poses::CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> landmarks;
  std::map<unsigned int, mrpt::maps::CLandmark::TLandmarkID> ids;
  mrpt::math::CVectorDouble mean;
  mrpt::math::CMatrixDouble cov;
};

/// Drives `count` steps of a simulated world; `distort` sees each increment before the filter does.
template <typename Distort>
void drive(RangeBearingSlam2D& slam, testing::SlamWorld& world, int count, Distort distort) {
  std::mt19937_64 random(3);
  for (int i = 0; i < count; ++i) {
    const double time = 0.1 * i;
    auto action = CActionCollection::Create();
    if (i > 0) {
      MotionAction moved = world.drive(random, 1.0);
      distort(moved);
      action = testing::make_action(moved, time);
    }
    auto frame = testing::make_frame(world.observe(random, 1.0), world.T_robot_sensor, time);
    slam.processActionObservation(action, frame);
  }
}

void drive(RangeBearingSlam2D& slam, int count) {
  testing::SlamWorld world;
  drive(slam, world, count, [](MotionAction&) {});
}

void expect_same_state(const Snapshot& ours, const Snapshot& stock) {
  constexpr double kTolerance = 1e-8;  // see tests/oracle
  ASSERT_EQ(ours.ids, stock.ids);
  ASSERT_EQ(ours.mean.size(), stock.mean.size());
  EXPECT_LT((ours.mean.asEigen() - stock.mean.asEigen()).cwiseAbs().maxCoeff(), kTolerance);
  EXPECT_LT((ours.cov.asEigen() - stock.cov.asEigen()).cwiseAbs().maxCoeff(), kTolerance);
  EXPECT_LT((ours.pose.cov.asEigen() - stock.pose.cov.asEigen()).norm(), kTolerance);
  EXPECT_NEAR(ours.pose.mean.x(), stock.pose.mean.x(), kTolerance);
  ASSERT_EQ(ours.landmarks.size(), stock.landmarks.size());
  for (std::size_t i = 0; i < ours.landmarks.size(); ++i)
    EXPECT_LT((ours.landmarks[i] - stock.landmarks[i]).norm(), kTolerance) << i;
}

TEST(RangeBearingSlam2d, EqualsMrptAtEveryFrameOfTheDemo) {
  RangeBearingSlam2D ours;
  mrpt::slam::CRangeBearingKFSLAM2D stock;
  RawlogPlayer player("/usr/share/mrpt/datasets/kf-slam_demo.rawlog");
  int frames = 0;
  while (auto step = player.next()) {
    if (!step->frame) continue;
    if (!step->action) step->action = CActionCollection::Create();
    stock.processActionObservation(step->action, step->frame);
    ours.processActionObservation(step->action, step->frame);
    expect_same_state(Snapshot(ours), Snapshot(stock));
    const auto& made = ours.getLastDataAssociation();
    const auto& expected = stock.getLastDataAssociation();
    ASSERT_EQ(made.results.associations, expected.results.associations);
    ASSERT_EQ(made.newly_inserted_landmarks, expected.newly_inserted_landmarks);
    ASSERT_FALSE(HasFailure()) << "frame " << frames;
    ++frames;
  }
  EXPECT_EQ(frames, 250);
}

TEST(RangeBearingSlam2d, StartsAtTheOriginAndReturnsThereOnReset) {
  RangeBearingSlam2D slam;
  EXPECT_EQ(Snapshot(slam).mean.size(), 3);
  drive(slam, 5);
  EXPECT_GT(Snapshot(slam).mean.size(), 3);
  slam.reset();
  const Snapshot state(slam);
  EXPECT_TRUE(state.mean.asEigen().isZero(0.0));
  EXPECT_TRUE(state.cov.asEigen().isZero(0.0));
  EXPECT_EQ(state.mean.size(), 3);
  EXPECT_TRUE(state.ids.empty());
}

TEST(RangeBearingSlam2d, LandmarksWithoutIdentityAreCalledByTheirPosition) {
  RangeBearingSlam2D slam;
  auto action = CActionCollection::Create();
  std::vector<Feature> features(3);
  for (int i = 0; i < 3; ++i) features[static_cast<std::size_t>(i)].z = Eigen::Vector2d(2.0 + i, i);
  auto frame = testing::make_frame(features, Eigen::Vector3d::Zero(), 1.0);
  slam.processActionObservation(action, frame);
  EXPECT_EQ(slam.getLastDataAssociation().newly_inserted_landmarks.size(), 3U);
  slam.processActionObservation(action, frame);
  using Ids = std::map<unsigned int, mrpt::maps::CLandmark::TLandmarkID>;
  EXPECT_EQ(Snapshot(slam).ids, (Ids{{0, 0}, {1, 1}, {2, 2}}));
  using Pairs = std::map<std::size_t, std::size_t>;
  EXPECT_EQ(slam.getLastDataAssociation().results.associations, (Pairs{{0, 0}, {1, 1}, {2, 2}}));
  EXPECT_EQ(slam.getLastDataAssociation().predictions_IDs, (std::vector<std::size_t>{0, 1, 2}));
}

TEST(RangeBearingSlam2d, StepWithoutOdometryAddsItsNoiseOnceThereIsAMap) {
  RangeBearingSlam2D slam;
  slam.options.stds_Q_no_odo[0] = slam.options.stds_Q_no_odo[1] = 0.5F;
  auto nothing = CActionCollection::Create();
  std::shared_ptr<mrpt::obs::CSensoryFrame> no_frame;
  slam.processActionObservation(nothing, no_frame);
  EXPECT_TRUE(Snapshot(slam).cov.asEigen().isZero(0.0));
  drive(slam, 2);
  const Snapshot before(slam);
  slam.processActionObservation(nothing, no_frame);
  const Snapshot after(slam);
  EXPECT_NEAR(after.cov(0, 0) - before.cov(0, 0), 0.25, 1e-12);
  EXPECT_EQ(after.mean[0], before.mean[0]);
}

TEST(RangeBearingSlam2d, DrawsMapAndRobot) {
  RangeBearingSlam2D slam;
  drive(slam, 5);
  std::shared_ptr<mrpt::opengl::CSetOfObjects> objects;
  slam.getAs3DObject(objects);
  ASSERT_TRUE(objects);
  const std::size_t landmarks = Snapshot(slam).landmarks.size();
  ASSERT_GT(landmarks, 3U);
  const auto count = [&] { return static_cast<std::size_t>(objects->end() - objects->begin()); };
  EXPECT_EQ(count(), landmarks + 2);  // and the robot and the axes of the world
  slam.getAs3DObject(objects);
  EXPECT_EQ(count(), landmarks + 2);
  const auto last = objects->getByName(std::to_string(landmarks - 1));
  ASSERT_TRUE(last);
  EXPECT_NEAR(last->getPoseX(), Snapshot(slam).landmarks.back().x, 1e-5);
}

TEST(RangeBearingSlam2d, WritesAMatlabScript) {
  const test::TemporaryDirectory directory;
  RangeBearingSlam2D slam;
  slam.options.create_simplemap = true;
  drive(slam, 5);
  const std::string file = (directory.path() / "map.m").string();
  slam.saveMapAndPath2DRepresentationAsMATLABFile(file, 3.0F, "b", "g");
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  const std::string script = text.str();
  std::size_t plots = 0;
  for (std::size_t at = 0; (at = script.find("plot(", at)) != std::string::npos; ++at) ++plots;
  EXPECT_EQ(plots, Snapshot(slam).landmarks.size() + 2) << script;  // and path and robot
  EXPECT_NE(script.find("plot(ROB_PATH(:,1),ROB_PATH(:,2),'g');"), std::string::npos);
  EXPECT_THROW(slam.saveMapAndPath2DRepresentationAsMATLABFile("/no/such/folder/map.m"),
               std::runtime_error);
}

/// What the wheels of a virtual track say if the left one counts 4 % too little, the right one 2 %
/// too much: the true travel is 1.04 and 0.98 times the logged one.
void falsify(MotionAction& moved) {
  constexpr double kTrack = 0.5;
  const double turn = moved.increment[2];
  const double along = moved.increment.head<2>().norm() * 0.5 * turn / std::sin(0.5 * turn);
  const double left = (along - 0.5 * kTrack * turn) / 1.04;
  const double right = (along + 0.5 * kTrack * turn) / 0.98;
  const double logged_turn = (right - left) / kTrack;
  const double chord = 0.5 * (left + right) * std::sin(0.5 * logged_turn) / (0.5 * logged_turn);
  moved.increment = {chord * std::cos(0.5 * logged_turn), chord * std::sin(0.5 * logged_turn),
                     logged_turn};
}

void configure(RangeBearingSlam2D& slam, const testing::SlamWorld& world, bool calibrate) {
  slam.options.std_sensor_range = static_cast<float>(world.sigma_range);
  slam.options.std_sensor_yaw = static_cast<float>(world.sigma_bearing);
  Parameters& p = slam.options.parameters;
  p.filter.error_frame = "right_invariant";
  p.motion.model = "differential";
  p.motion.track_width = 0.5;
  p.calibration.scale_left.enabled = p.calibration.scale_right.enabled = calibrate;
}

TEST(RangeBearingSlam2d, CalibratesFalsifiedOdometry) {
  constexpr int kSteps = 300;
  testing::SlamWorld world, same_world;
  RangeBearingSlam2D calibrated, plain;
  configure(calibrated, world, true);
  configure(plain, world, false);
  drive(calibrated, world, kSteps, falsify);
  drive(plain, same_world, kSteps, falsify);

  const std::vector<CalibrationValue> found = calibrated.getCurrentCalibration();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_TRUE(plain.getCurrentCalibration().empty());
  const double truth[] = {1.04, 0.98};
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(found[i].observable) << found[i].name;
    EXPECT_LT(found[i].sigma, 0.003) << found[i].name;
    EXPECT_NEAR(found[i].mean, truth[i], 4.0 * found[i].sigma) << found[i].name;
  }
  // Squared Mahalanobis distance of the pose from the truth; .9999 of chi-square with 3 degrees of
  // freedom is 21.1.
  const auto nees = [&](const RangeBearingSlam2D& slam) {
    const Snapshot state(slam);
    Eigen::Vector3d error = state.mean.asEigen().head<3>() - world.pose;
    error[2] = wrap_angle(error[2]);
    return error.dot(state.pose.cov.asEigen().ldlt().solve(error));
  };
  EXPECT_LT(nees(calibrated), 21.1);
  EXPECT_GT(nees(plain), 21.1);
  // Calibration is no part of what MRPT's callers get.
  const Snapshot state(calibrated);
  EXPECT_EQ(state.mean.size(), static_cast<int>(3 + 2 * state.landmarks.size()));
  EXPECT_EQ(state.cov.cols(), state.mean.size());
  const Eigen::Vector2d last(state.landmarks.back().x, state.landmarks.back().y);
  EXPECT_EQ(state.mean.asEigen().tail<2>(), last);
}

class LoggedSlam2d : public ::testing::Test {
 protected:
  LoggedSlam2d() {
    slam_.logging_enable_console_output = false;
    slam_.logging_enable_keep_record = true;
    slam_.setMinLoggingLevel(mrpt::system::LVL_DEBUG);
  }
  bool logged(std::string_view text) {
    std::string all;
    slam_.getLogAsString(all);
    return all.find(text) != std::string::npos;
  }
  RangeBearingSlam2D slam_;
};

TEST_F(LoggedSlam2d, WarnsOfOptionsThatAreNotFollowed) {
  drive(slam_, 1);
  EXPECT_FALSE(logged("data_assoc_method"));
  EXPECT_TRUE(logged("pair 1: 0 sightings"));
  slam_.options.data_assoc_method = mrpt::slam::assocJCBB;
  slam_.options.data_assoc_IC_metric = mrpt::slam::metricML;
  slam_.KF_options.method = mrpt::bayes::kfIKF;
  slam_.reset();
  drive(slam_, 1);
  for (const char* option : {"data_assoc_method", "data_assoc_IC_metric", "KF_options.method"})
    EXPECT_TRUE(logged(option)) << option;
}

TEST_F(LoggedSlam2d, SurvivesAMovementThatIsNotFinite) {
  drive(slam_, 5);
  MotionAction moved;
  moved.increment[0] = std::numeric_limits<double>::quiet_NaN();
  auto action = testing::make_action(moved, 0.6);
  auto frame = mrpt::obs::CSensoryFrame::Create();
  slam_.processActionObservation(action, frame);
  EXPECT_TRUE(Snapshot(slam_).mean.asEigen().allFinite());
  EXPECT_TRUE(logged("not finite"));
}

}  // namespace
}  // namespace libslam
