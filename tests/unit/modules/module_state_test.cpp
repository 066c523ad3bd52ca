// What a saved state is worth, whole or not. tests/property/module_continuation_test.cpp has the
// runs that go on.

#include <random>
#include <string>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <libslam/io/input_error.hpp>
#include <libslam/modules/module_state.hpp>
#include <libslam/modules/range_bearing_slam_2d.hpp>
#include <libslam/modules/slam_map_builder.hpp>

#include "support/mrpt_pair.hpp"
#include "support/slam_world.hpp"

namespace libslam {
namespace {

template <typename Module>
std::string saved(const Module& module) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  module.saveState(archive);
  return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
}

template <typename Module>
void load(Module& module, const std::string& bytes) {
  mrpt::io::CMemoryStream stream;
  stream.Write(bytes.data(), bytes.size());
  stream.Seek(0);
  auto archive = mrpt::serialization::archiveFrom(stream);
  module.loadState(archive);
}

template <typename Module>
std::string rejection(Module& module, const std::string& bytes) {
  try {
    load(module, bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

void drive(RangeBearingSlam2D& slam, int count) {
  testing::SlamWorld world;
  std::mt19937_64 random(3);
  for (int i = 0; i < count; ++i) {
    auto action = testing::make_action(world.drive(random, 1.0), 0.1 * i);
    auto frame = testing::make_frame(world.observe(random, 1.0), world.T_robot_sensor, 0.1 * i);
    slam.processActionObservation(action, frame);
  }
}

class SavedModule : public ::testing::Test {
 protected:
  SavedModule() {
    drive(slam_, 20);
    bytes_ = saved(slam_);
    other_.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    drive(other_, 3);
    before_ = saved(other_);
  }
  /// The message is one line and the module is as it was.
  void expect_rejected(const std::string& bytes, const std::string& text) {
    const std::string message = rejection(other_, bytes);
    EXPECT_EQ(message.find("saved state: "), 0U) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find(text), std::string::npos) << message;
    EXPECT_EQ(saved(other_), before_);
  }

  RangeBearingSlam2D slam_, other_;
  std::string bytes_, before_;
};

TEST_F(SavedModule, ComesBackAsItWas) {
  load(other_, bytes_);
  EXPECT_EQ(saved(other_), bytes_);
}

TEST_F(SavedModule, StartsAgainAfterReset) {
  load(other_, bytes_);
  other_.reset();
  mrpt::poses::CPosePDFGaussian pose;
  other_.getCurrentRobotPose(pose);
  EXPECT_EQ(pose.mean.norm(), 0.0);
}

TEST_F(SavedModule, CutOffAnywhereIsRejected) {
  for (std::size_t length = 0; length < bytes_.size(); length += 1 + length / 7)
    expect_rejected(bytes_.substr(0, length), "ends early");
}

TEST_F(SavedModule, AnyWrongByteIsRejected) {
  std::mt19937 random(11);
  std::uniform_int_distribution<std::size_t> place(0, bytes_.size() - 1);
  for (int trial = 0; trial < 200; ++trial) {
    std::string wrong = bytes_;
    wrong[trial < 40 ? static_cast<std::size_t>(trial) : place(random)] ^= 0x41;
    expect_rejected(wrong, "");
  }
}

TEST_F(SavedModule, SaysWhatIsWrong) {
  expect_rejected(std::string(100, 'x'), "is none, or of another version");
  std::string huge = bytes_;
  huge.replace(10, 8, 8, '\x7f');  // the number of bytes: beyond any memory
  expect_rejected(huge, "ends early");
  std::string wrong = bytes_;
  wrong[wrong.size() / 2] ^= 1;
  expect_rejected(wrong, "digest");
}

TEST_F(SavedModule, OfOtherOptionsIsRejected) {
  SlamMapBuilder builder;  // its state has key frames behind the filter
  EXPECT_EQ(rejection(builder, bytes_), "saved state: its key frames cannot be read");
  std::string state = saved(builder);
  builder.slam_options.parameters.measurement.model = "sensor_displacement";
  EXPECT_ANY_THROW(load(builder, state));
}

}  // namespace
}  // namespace libslam
