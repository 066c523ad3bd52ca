// Maps that go into a SlamMapBuilder and come out of it.

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <mrpt/maps/CBeaconMap.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <libslam/io/input_error.hpp>
#include <libslam/modules/simple_map_carrier.hpp>
#include <libslam/modules/slam_map_builder.hpp>

#include "map_builder_run.hpp"
#include "support/temporary_directory.hpp"

namespace libslam {
namespace {

using mrpt::maps::CBeaconMap;
using mrpt::maps::CSimpleMap;
using mrpt::poses::CPosePDFGaussian;
using test::pose_of;
using test::run;

class BuiltMap : public ::testing::Test {
 protected:
  BuiltMap() {
    for (SlamMapBuilder* builder : {&first_, &second_}) {
      builder->setMinLoggingLevel(mrpt::system::LVL_ERROR);
      builder->slam_options.parameters = test::demo_parameters();
      builder->initialize();
    }
    run(first_, steps_);
    first_.getCurrentlyBuiltMap(map_);
  }

  static const CBeaconMap& landmarks(const SlamMapBuilder& builder) {
    return *builder.getCurrentlyBuiltMetricMap()->mapByClass<CBeaconMap>();
  }
  static void expect_same_landmarks(const CBeaconMap& ours, const CBeaconMap& expected,
                                    double tolerance) {
    ASSERT_EQ(ours.size(), expected.size());
    for (std::size_t i = 0; i < ours.size(); ++i) {
      const auto &a = ours.get(i), &b = expected.get(i);
      EXPECT_EQ(a.m_ID, b.m_ID);
      EXPECT_LE((a.m_locationGauss.mean - b.m_locationGauss.mean).norm(), tolerance) << i;
      EXPECT_LE((a.m_locationGauss.cov - b.m_locationGauss.cov).norm(), tolerance) << i;
    }
  }

  SlamMapBuilder first_, second_;
  CSimpleMap map_;
  const std::vector<LogStep> steps_ = test::read_log(test::kDemo);
};

TEST_F(BuiltMap, GoesThroughAFileWithNothingLost) {
  const test::TemporaryDirectory directory;
  const std::string file = (directory.path() / "demo.simplemap").string();
  first_.saveCurrentMapToFile(file);
  second_.loadCurrentMapFromFile(file);
  EXPECT_EQ(second_.getCurrentlyBuiltMapSize(), first_.getCurrentlyBuiltMapSize());
  expect_same_landmarks(landmarks(second_), landmarks(first_), 0.0);
  EXPECT_EQ(pose_of(second_).mean.norm(), 0.0);  // where it was
  CSimpleMap again;
  second_.getCurrentlyBuiltMap(again);
  for (std::size_t i = 0; i < map_.size(); ++i)
    EXPECT_EQ(again.getAsPair(i).sf->size(), map_.getAsPair(i).sf->size()) << i;
}

// In a map that it has made the robot knows where it is from the first sighting on, and the map
// stays what it is.
TEST_F(BuiltMap, IsWhatTheNextDriveLocalizesIn) {
  const CPosePDFGaussian start(mrpt::poses::CPose2D(0.3, -0.2, 0.05), [] {
    mrpt::math::CMatrixDouble33 cov;
    cov(0, 0) = cov(1, 1) = 0.25;
    cov(2, 2) = 0.01;
    return cov;
  }());
  second_.enableMapUpdating(false);
  second_.initialize(map_, &start);
  EXPECT_NEAR(pose_of(second_).mean.x(), 0.3, 1e-12);
  EXPECT_NEAR(pose_of(second_).cov(0, 0), 0.25, 1e-12);
  run(second_, steps_, 0, 5);
  const auto pose = pose_of(second_);
  SlamMapBuilder reference;
  reference.slam_options.parameters = test::demo_parameters();
  const auto path = run(reference, steps_, 0, 5);
  EXPECT_LT((pose.mean.asTPose() - path.back().mean.asTPose()).norm(), 0.05);
  EXPECT_LT(std::sqrt(pose.cov(0, 0)), 0.05);
  run(second_, steps_, 5);
  EXPECT_EQ(second_.getCurrentlyBuiltMapSize(), map_.size());
  expect_same_landmarks(landmarks(second_), landmarks(first_), 1e-12);
}

TEST_F(BuiltMap, GrowsAgainWhenItMay) {
  run(second_, steps_, 0, 60);
  const std::size_t landmarks_then = landmarks(second_).size();
  const unsigned frames_then = second_.getCurrentlyBuiltMapSize();
  second_.enableMapUpdating(false);
  run(second_, steps_, 60, 120);
  EXPECT_EQ(landmarks(second_).size(), landmarks_then);
  EXPECT_EQ(second_.getCurrentlyBuiltMapSize(), frames_then);
  second_.enableMapUpdating(true);
  run(second_, steps_, 120);
  EXPECT_GT(landmarks(second_).size(), landmarks_then);
  EXPECT_GT(second_.getCurrentlyBuiltMapSize(), frames_then);
}

// A simple map of another program has frames alone; the landmarks are where its poses see them.
TEST_F(BuiltMap, OfAnotherProgramIsReadFromItsFrames) {
  CSimpleMap frames;
  for (const auto& [pose, frame] : map_) frames.insert(pose, without_map(frame));
  EXPECT_FALSE(attached_map(frames));
  second_.initialize(frames);
  const CBeaconMap &ours = landmarks(second_), &expected = landmarks(first_);
  ASSERT_GT(ours.size(), 30U);
  // Key frames have the poses of their time, off by centimetres at most in this log.
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const CBeaconMap& all = expected;
    bool found = false;
    for (std::size_t k = 0; k < all.size() && !found; ++k)
      if (all.get(k).m_ID == ours.get(i).m_ID) {
        found = true;
        EXPECT_LT((all.get(k).m_locationGauss.mean - ours.get(i).m_locationGauss.mean).norm(), 0.2);
      }
    EXPECT_TRUE(found) << i;
  }
}

TEST_F(BuiltMap, IsDamagedInOneClearLine) {
  auto& last = map_.getAsPair(map_.size() - 1);
  for (const auto& observation : *last.sf)
    if (auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(observation))
      comment->text[comment->text.size() / 2] ^= 1;
  try {
    second_.initialize(map_);
    FAIL() << "a damaged map was taken";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find("simple map: the landmark map in frame "), 0U) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  EXPECT_EQ(second_.getCurrentlyBuiltMapSize(), 0U);
}

}  // namespace
}  // namespace libslam
