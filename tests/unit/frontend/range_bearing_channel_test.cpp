#include <string>

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationBearingRange.h>

#include <libslam/frontend/range_bearing_observation.hpp>

namespace libslam {
namespace {

void insert_sighting(mrpt::obs::CSensoryFrame& frame, const std::string& label) {
  auto observation = mrpt::obs::CObservationBearingRange::Create();
  observation->sensorLabel = label;
  observation->sensedData.emplace_back().range = 1.0F;
  frame.insert(observation);
}

TEST(RangeBearingObservation, SensorsAreChannelsInTheOrderOfTheirAppearance) {
  RangeBearingObservation frontend({}, {}, "", true);
  std::vector<FeatureBatch> batches;
  for (int frame_number = 0; frame_number < 2; ++frame_number) {
    mrpt::obs::CSensoryFrame frame;
    for (const char* label : {"rear", "front", "rear"}) insert_sighting(frame, label);
    frontend.extract(frame, batches);
    ASSERT_EQ(batches.size(), 3U);
    EXPECT_EQ(batches[0][0].channel, 0);
    EXPECT_EQ(batches[1][0].channel, 1);
    EXPECT_EQ(batches[2][0].channel, 0);
  }
}

TEST(RangeBearingObservation, ALogFullOfLabelsDoesNotMakeEndlessChannels) {
  RangeBearingObservation frontend({}, {}, "", true);
  std::vector<FeatureBatch> batches;
  mrpt::obs::CSensoryFrame frame;
  for (int i = 0; i < 300; ++i) insert_sighting(frame, std::to_string(i));
  frontend.extract(frame, batches);
  EXPECT_EQ(batches[99][0].channel, 99);
  EXPECT_EQ(batches[299][0].channel, 99);
}

}  // namespace
}  // namespace libslam
