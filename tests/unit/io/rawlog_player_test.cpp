#include <chrono>
#include <cmath>
#include <limits>
#include <support/temporary_directory.hpp>

#include <gtest/gtest.h>

#include <libslam/io/input_error.hpp>
#include <libslam/io/rawlog_player.hpp>
#include <libslam/io/truth_reader.hpp>

#include "log_builder.hpp"

namespace libslam {
namespace {

using namespace libslam::test;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const std::string kPackaged = "/usr/share/mrpt/datasets/";

class RawlogPlayerTest : public testing::Test {
 protected:
  template <typename... Objects>
  std::string log(const Objects&... objects) {
    return write_log(directory_.path() / "log.rawlog", true, objects...);
  }
  TemporaryDirectory directory_;
};

TEST_F(RawlogPlayerTest, PairsWithLeadingFrameAndTrailingAction) {
  RawlogPlayer player(log(frame(5.0), action(6.0, 0.1, 0.01), frame(6.0), action(7.5, 0.2),
                          frame(7.5), action(8.0, 0.3)));
  const auto steps = play(player);
  ASSERT_EQ(steps.size(), 4U);
  EXPECT_TRUE(player.is_pair_log());
  EXPECT_FALSE(steps[0].action);
  EXPECT_TRUE(steps[0].frame);
  EXPECT_DOUBLE_EQ(steps[1].dt, 1.0);
  EXPECT_DOUBLE_EQ(steps[2].dt, 1.5);
  EXPECT_TRUE(steps[1].has_motion_covariance);
  EXPECT_FALSE(steps[2].has_motion_covariance);
  EXPECT_FALSE(steps[3].frame);
  EXPECT_DOUBLE_EQ(motion_of(steps[3])->rawOdometryIncrementReading.x(), 0.3);
  for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(steps[i].index, static_cast<int>(i));
  const InputSummary& s = player.summary();
  EXPECT_EQ(s.entries, 6);
  EXPECT_EQ(s.actions, 3);
  EXPECT_EQ(s.observations, 3);
  EXPECT_DOUBLE_EQ(s.duration_s, 3.0);
  EXPECT_TRUE(s.leading_frame);
  EXPECT_FALSE(s.incomplete());
  EXPECT_EQ(s.repaired, 0);
  EXPECT_EQ(player.progress(), 1.0);
}

TEST_F(RawlogPlayerTest, TimesOfPairsBecomeFiniteAndNeverDecrease) {
  const auto file = log(action(kNoTime, 0.1), frame(kNoTime), action(kNoTime, 0.1), frame(3.0),
                        action(kNoTime, 0.1), frame(2.0), action(4.0, 0.1), frame(kNoTime));
  RawlogPlayer player(file);
  const auto steps = play(player);
  ASSERT_EQ(steps.size(), 4U);
  EXPECT_EQ(steps[0].time, 0.0);
  EXPECT_EQ(steps[1].time, 3.0);
  EXPECT_EQ(steps[1].dt, 0.0);  // the start of this motion has no valid time
  EXPECT_EQ(steps[2].time, 3.0);
  EXPECT_EQ(steps[3].time, 4.0);  // stamp of the action
  EXPECT_EQ(player.summary().repaired, 2);
  EXPECT_EQ(player.summary().skipped, 0);
  RawlogPlayer strict(file, with_policy("strict"));
  EXPECT_THROW(play(strict), InputError);
}

TEST_F(RawlogPlayerTest, ObservationsWithAbsoluteOdometry) {
  RawlogPlayer player(log(sighting(0.5), odometry(1.0, 5.0, 5.0, 0.0), odometry(2.0, 6.0, 5.0, 0.0),
                          sighting(1.5), frame(2.0), sighting(2.5)));
  const auto steps = play(player);
  ASSERT_EQ(steps.size(), 4U);
  EXPECT_FALSE(player.is_pair_log());
  EXPECT_FALSE(steps[0].action);
  EXPECT_NEAR(motion_of(steps[1])->rawOdometryIncrementReading.x(), 0.5, 1e-15);
  EXPECT_NEAR(motion_of(steps[2])->rawOdometryIncrementReading.x(), 0.5, 1e-15);
  EXPECT_TRUE(steps[2].frame);
  EXPECT_FALSE(steps[3].action);
  EXPECT_EQ(player.summary().observations, 4);
  EXPECT_EQ(player.summary().actions, 2);
}

TEST_F(RawlogPlayerTest, CompressedAndPlainGiveTheSame) {
  const auto write = [&](bool packed) {
    return write_log(directory_.path() / (packed ? "a.rawlog" : "b.rawlog"), packed,
                     odometry(1.0, 0.0, 0.0, 0.0), sighting(1.5), odometry(2.0, 1.0, 0.5, 0.2));
  };
  RawlogPlayer packed(write(true)), plain(write(false));
  const auto a = play(packed), b = play(plain);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].time, b[i].time);
    EXPECT_EQ(motion_of(a[i])->rawOdometryIncrementReading,
              motion_of(b[i])->rawOdometryIncrementReading);
  }
}

TEST_F(RawlogPlayerTest, LabelsSelectSensors) {
  auto other = odometry(1.5, 77.0, 0.0, 0.0);
  other.sensorLabel = "visual";
  auto camera = sighting(1.7);
  camera.sensorLabel = "camera";
  PlayerOptions options;
  options.input.odometry_label = "wheels";
  options.input.sensor_label = "laser";
  RawlogPlayer player(
      log(odometry(1.0, 0.0, 0.0, 0.0), other, camera, sighting(1.8), odometry(2.0, 1.0, 0.0, 0.0)),
      options);
  double moved = 0.0;
  for (const LogStep& step : play(player))
    moved += motion_of(step)->rawOdometryIncrementReading.x();
  EXPECT_NEAR(moved, 1.0, 1e-15);
  EXPECT_EQ(player.summary().observations, 1);
  EXPECT_EQ(player.summary().skipped, 0);
}

TEST_F(RawlogPlayerTest, NonFiniteOdometryIsBridgedByTheNextReading) {
  const auto file = log(odometry(1.0, 0.0, 0.0, 0.0), odometry(2.0, kNan, 0.0, 0.0),
                        odometry(3.0, 4.0, 0.0, 0.0));
  RawlogPlayer player(file);
  const auto steps = play(player);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_DOUBLE_EQ(motion_of(steps[0])->rawOdometryIncrementReading.x(), 4.0);
  EXPECT_DOUBLE_EQ(steps[0].dt, 2.0);
  EXPECT_EQ(player.summary().skipped, 1);
  ASSERT_EQ(player.summary().warnings.size(), 1U);
  EXPECT_NE(player.summary().warnings[0].find("entry 1: odometry is not finite"),
            std::string::npos);
}

TEST_F(RawlogPlayerTest, LateObservationIsRejectedLeftOutOrMovedByPolicy) {
  const auto file =
      log(odometry(1.0, 0.0, 0.0, 0.0), odometry(2.0, 1.0, 0.0, 0.0), odometry(3.0, 2.0, 0.0, 0.0),
          odometry(4.0, 3.0, 0.0, 0.0), sighting(1.5), odometry(5.0, 4.0, 0.0, 0.0));
  RawlogPlayer strict(file, with_policy("strict"));
  try {
    play(strict);
    FAIL() << "strict accepted an observation from the past";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("log.rawlog: entry 4: observation is"),
              std::string::npos);
  }
  RawlogPlayer skip(file, with_policy("skip")), repair(file, with_policy("repair"));
  play(skip);
  EXPECT_EQ(skip.summary().skipped, 1);
  EXPECT_EQ(skip.summary().observations, 0);
  double time_seen = 0.0;
  for (const LogStep& step : play(repair))
    if (step.frame) time_seen = step.time;
  EXPECT_EQ(repair.summary().repaired, 1);
  EXPECT_EQ(time_seen, 3.0);
}

TEST_F(RawlogPlayerTest, OdometryBackInTimeLosesNoMotion) {
  const auto file = log(odometry(1.0, 0.0, 0.0, 0.0), odometry(3.0, 2.0, 0.0, 0.0),
                        odometry(2.0, 2.5, 0.0, 0.0), odometry(4.0, 3.0, 0.0, 0.0));
  for (const char* policy : {"skip", "repair"}) {
    RawlogPlayer player(file, with_policy(policy));
    double moved = 0.0;
    for (const LogStep& step : play(player))
      moved += motion_of(step)->rawOdometryIncrementReading.x();
    EXPECT_NEAR(moved, 3.0, 1e-14) << policy;
  }
}

TEST_F(RawlogPlayerTest, ForeignClassIsLeftOut) {
  const auto file = log(mrpt::poses::CPosePDFGaussian(), action(1.0, 0.1), frame(1.0));
  RawlogPlayer player(file);
  EXPECT_EQ(play(player).size(), 1U);
  EXPECT_EQ(player.summary().skipped, 1);
  RawlogPlayer strict(file, with_policy("strict"));
  EXPECT_THROW(play(strict), InputError);
}

TEST_F(RawlogPlayerTest, MotionThatIsNotFiniteIsLeftOutAndTheFrameStays) {
  RawlogPlayer player(log(action(1.0, kNan), frame(1.0), action(2.0, 0.5), frame(2.0)));
  const auto steps = play(player);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_FALSE(steps[0].action);
  EXPECT_TRUE(steps[0].frame);
  EXPECT_EQ(player.summary().skipped, 1);
}

TEST_F(RawlogPlayerTest, WarningsAreBounded) {
  const std::string file = (directory_.path() / "many.rawlog").string();
  {
    mrpt::io::CFileGZOutputStream out(file);
    auto archive = mrpt::serialization::archiveFrom(out);
    for (int i = 0; i < 500; ++i) archive << odometry(i, kNan, 0.0, 0.0);
  }
  RawlogPlayer player(file);
  play(player);
  const InputSummary& s = player.summary();
  EXPECT_EQ(s.skipped, 500);
  EXPECT_EQ(static_cast<std::int64_t>(s.warnings.size()) + s.warnings_omitted, 500);
  EXPECT_LE(s.warnings.size(), 50U);
}

TEST_F(RawlogPlayerTest, RealTimeTakesTheTimeOfTheLogDividedByTheFactor) {
  PlayerOptions options;
  options.pacing = {PaceMode::kRealTime, 10.0, {}};
  RawlogPlayer player(log(odometry(0.0, 0, 0, 0), odometry(1.0, 1, 0, 0), odometry(2.0, 2, 0, 0),
                          odometry(3.0, 3, 0, 0)),
                      options);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(play(player).size(), 3U);  // at 1, 2 and 3 s: 0.2 s at this pace
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_GE(taken.count(), 0.2);
}

TEST_F(RawlogPlayerTest, StepCallbackEndsThePlayback) {
  PlayerOptions options;
  int asked = 0;
  options.pacing = {PaceMode::kStep, 1.0, [&](const LogStep&) { return ++asked < 3; }};
  RawlogPlayer player(log(frame(1.0), action(2.0, 0.1), frame(2.0), action(3.0, 0.1), frame(3.0)),
                      options);
  EXPECT_EQ(play(player).size(), 2U);
  EXPECT_FALSE(player.next().has_value());
  EXPECT_EQ(asked, 3);
}

TEST_F(RawlogPlayerTest, UnknownPolicyAndPaceAreRefused) {
  const auto file = log(frame(1.0));
  EXPECT_THROW(RawlogPlayer(file, with_policy("lenient")), std::invalid_argument);
  PlayerOptions options;
  options.pacing.factor = 0.0;
  EXPECT_THROW(RawlogPlayer(file, options), std::invalid_argument);
}

TEST(PackagedLogs, TruthRowOfASimulatedPairLogIsTheIndexOfItsStep) {
  RawlogPlayer player(kPackaged + "kf-slam_demo.rawlog");
  const auto steps = play(player);
  const Trajectory truth = read_true_path(kPackaged + "kf-slam_demo_ground_truth_robot_path.txt");
  ASSERT_EQ(truth.poses.size(), 250U);
  ASSERT_EQ(steps.size(), 251U);  // the leading frame, 249 pairs, and an action without frame
  EXPECT_FALSE(steps[0].action);
  EXPECT_FALSE(steps[250].frame);
  // Odometry against the motion between truth rows, for this and the neighbouring assignments.
  const auto residual = [&](int shift) {
    double sum = 0.0;
    int count = 0;
    for (int k = 3; k < 247; ++k, ++count) {
      const auto row = [&](int i) {
        const Eigen::Vector3d& p = truth.poses[static_cast<std::size_t>(i)];
        return mrpt::poses::CPose2D(p.x(), p.y(), p.z());
      };
      const auto moved = row(k + shift) - row(k + shift - 1);
      const auto read = motion_of(steps[static_cast<std::size_t>(k)])->rawOdometryIncrementReading;
      sum += std::pow(moved.phi() - read.phi(), 2) + std::pow(moved.x() - read.x(), 2);
    }
    return std::sqrt(sum / count);
  };
  EXPECT_LT(residual(0), 0.8 * residual(-1));
  EXPECT_LT(residual(0), 0.8 * residual(1));
}

TEST(PackagedLogs, AllStockLogsPlay) {
  const std::map<std::string, std::int64_t> entries = {{"kf-slam_6D_demo.rawlog", 1200},
                                                       {"localization_demo.rawlog", 0},
                                                       {"RO-SLAM_demo.rawlog", 0},
                                                       {"uwb_ro-localization_demo.rawlog", 686}};
  for (const auto& [name, count] : entries) {
    RawlogPlayer player(kPackaged + name);
    double time = 0.0;
    for (const LogStep& step : play(player)) {
      EXPECT_TRUE(std::isfinite(step.time) && step.time >= time) << name;
      EXPECT_GE(step.dt, 0.0);
      time = step.time;
    }
    EXPECT_FALSE(player.summary().incomplete()) << name;
    if (count > 0)
      EXPECT_EQ(player.summary().entries, count) << name;
    else
      EXPECT_GT(player.summary().entries, 10) << name;
  }
}

}  // namespace
}  // namespace libslam
