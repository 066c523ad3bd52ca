// A simulated drive in memory and read back from its log must be the same drive.

#include <support/temporary_directory.hpp>
#include <unit/simulation/drive_fixture.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/serialization/CArchive.h>

#include <libslam/io/rawlog_player.hpp>
#include <libslam/io/simulated_log.hpp>
#include <libslam/io/truth_reader.hpp>
#include <libslam/pipeline/pipeline.hpp>
#include <libslam/result/trajectory.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {
namespace {

using namespace libslam::testing;
using libslam::test::TemporaryDirectory;

std::string bytes_of(const mrpt::serialization::CSerializable& object) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << object;
  return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
}

std::vector<LogStep> play(const std::filesystem::path& rawlog) {
  RawlogPlayer player(rawlog.string());
  std::vector<LogStep> steps;
  while (auto step = player.next()) steps.push_back(std::move(*step));
  EXPECT_FALSE(player.summary().incomplete());
  EXPECT_EQ(player.summary().repaired, 0);
  EXPECT_TRUE(player.summary().warnings.empty());
  return steps;
}

void write_log(const Scenario& scenario, const std::vector<SimulatedStep>& steps,
               const Simulator& simulator, const std::filesystem::path& rawlog,
               LogFlavour flavour) {
  SimulatedLogWriter writer(rawlog, flavour, scenario.log.odometry == "ticks");
  for (const SimulatedStep& step : steps) writer.add(step.step, step.T_world_robot);
  writer.finish(simulator.landmarks(), simulator.calibration(), {});
}

/// trajectory.csv of a filter over the steps.
std::string filter_over(const Scenario& s, const std::vector<LogStep>& steps) {
  Parameters p;
  p.motion = s.motion;
  p.input.odometry = s.log.odometry;
  p.calibration.scale_left.enabled = p.calibration.scale_right.enabled = true;
  Pipeline pipeline(p);
  std::string text;
  for (const LogStep& step : steps) append_trajectory_row(text, pipeline.process(step));
  return text;
}

std::vector<LogStep> steps_of(const std::vector<SimulatedStep>& simulated) {
  std::vector<LogStep> steps;
  for (const SimulatedStep& step : simulated) steps.push_back(step.step);
  return steps;
}

struct Case {
  const char* flavour;
  const char* odometry;
};

class SimulatedPairLog : public ::testing::TestWithParam<Case> {
 protected:
  SimulatedPairLog() {
    scenario_ = differential_scenario();
    scenario_.log.flavour = GetParam().flavour;
    scenario_.log.odometry = GetParam().odometry;
    scenario_.beacons.enabled = true;
    scenario_.stereo.enabled = true;
    scenario_.laser.enabled = true;
    scenario_.laser.beams = 31;
    simulated_ = drive(scenario_, 11);
    write_log(scenario_, simulated_, *make_simulator(scenario_, 11), rawlog_, LogFlavour::kPairs);
  }

  TemporaryDirectory directory_;
  std::filesystem::path rawlog_ = directory_.path() / "a.rawlog";
  Scenario scenario_;
  std::vector<SimulatedStep> simulated_;
};

TEST_P(SimulatedPairLog, ReadsBackStepByStepBitForBit) {
  const std::vector<LogStep> played = play(rawlog_);
  ASSERT_EQ(played.size(), simulated_.size());
  for (std::size_t i = 0; i < played.size(); ++i) {
    const LogStep &a = simulated_[i].step, &b = played[i];
    ASSERT_EQ(a.index, b.index);
    ASSERT_EQ(a.time, b.time) << i;
    ASSERT_EQ(a.dt, b.dt) << i;
    ASSERT_EQ(a.has_motion_covariance, b.has_motion_covariance) << i;
    ASSERT_EQ(a.action != nullptr, b.action != nullptr) << i;
    if (a.action) {
      ASSERT_EQ(bytes_of(*a.action), bytes_of(*b.action)) << i;
    }
    ASSERT_EQ(b.frame->size(), a.frame ? a.frame->size() : 0U) << i;
    if (a.frame) {
      ASSERT_EQ(bytes_of(*a.frame), bytes_of(*b.frame)) << i;
    }
  }
}

TEST_P(SimulatedPairLog, GivesTheFilterTheSameBytes) {
  EXPECT_EQ(filter_over(scenario_, steps_of(simulated_)), filter_over(scenario_, play(rawlog_)));
}

INSTANTIATE_TEST_SUITE_P(FlavoursAndFields, SimulatedPairLog,
                         ::testing::Values(Case{"pairs", "increments"}, Case{"pairs", "velocities"},
                                           Case{"pairs", "ticks"},
                                           Case{"merged_pairs", "increments"},
                                           Case{"merged_pairs", "ticks"}));

TEST(SimulatedObservationLog, HoldsTheSameMotionsAndObservations) {
  Scenario s = differential_scenario();
  s.log.flavour = "observations";
  s.log.odometry = "ticks";
  const TemporaryDirectory directory;
  const auto rawlog = directory.path() / "a.rawlog";
  const auto simulated = drive(s, 3);
  write_log(s, simulated, *make_simulator(s, 3), rawlog, LogFlavour::kObservations);
  std::vector<LogStep> played;
  for (LogStep& step : play(rawlog)) played.push_back(std::move(step));
  ASSERT_EQ(played.size(), simulated.size());
  for (std::size_t i = 1; i < played.size(); ++i) {
    const auto logged =
        simulated[i].step.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
    const auto read = played[i].action->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
    // Absolute poses of some 50 m in double precision, subtracted.
    const auto difference = read->poseChange->getMeanVal() - logged->poseChange->getMeanVal();
    ASSERT_LT(difference.norm() + std::abs(difference.phi()), 1e-12);
    ASSERT_EQ(read->encoderLeftTicks, logged->encoderLeftTicks);
    ASSERT_EQ(read->encoderRightTicks, logged->encoderRightTicks);
    ASSERT_EQ(played[i].frame != nullptr, simulated[i].step.frame != nullptr);
    if (played[i].frame) {
      ASSERT_EQ(bytes_of(*played[i].frame), bytes_of(*simulated[i].step.frame));
    }
  }
}

TEST(SimulatedLogWriter, TruthIsFoundAndReadBack) {
  Scenario s = small_scenario();
  s.truth.scale_left = s.truth.scale_right = 1.05;
  const TemporaryDirectory directory;
  const auto rawlog = directory.path() / "a.rawlog";
  const auto simulated = drive(s, 3);
  const auto simulator = make_simulator(s, 3);
  write_log(s, simulated, *simulator, rawlog, LogFlavour::kPairs);
  const GroundTruth truth = read_truth(find_truth(rawlog.string()));
  ASSERT_EQ(truth.path.poses.size(), simulated.size());
  for (std::size_t i = 0; i < simulated.size(); ++i) {
    EXPECT_EQ(truth.path.times[i], simulated[i].step.time);
    EXPECT_LT((truth.path.poses[i] - simulated[i].T_world_robot).norm(), 2e-9);  // 9 decimals
  }
  ASSERT_EQ(truth.landmarks.size(), simulator->landmarks().size());
  EXPECT_EQ(truth.landmarks[5].position, simulator->landmarks()[5].position);
  EXPECT_DOUBLE_EQ(truth.calibration.at("scale_left"), 1.05);
}

TEST(SimulatedLogWriter, LeavesNothingWhereItIsNotFinished) {
  const TemporaryDirectory directory;
  {
    SimulatedLogWriter writer(directory.path() / "a.rawlog", LogFlavour::kPairs, false);
    for (const auto& step : drive(small_scenario(), 1)) writer.add(step.step, step.T_world_robot);
  }
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
  EXPECT_THROW(SimulatedLogWriter("/no/such/place/a.rawlog", LogFlavour::kPairs, false),
               std::runtime_error);
}

}  // namespace
}  // namespace libslam
