// Adapted noise that is far from what was configured.

#include <gtest/gtest.h>

#include <libslam/policy/noise_warnings.hpp>

using namespace libslam;

TEST(NoiseWarnings, BelowAThirdOrAboveThreeTimes) {
  const std::vector<AdaptedNoise> usual = {
      {"range", 0.59, 0.2, "m"}, {"bearing", 0.00585, 0.0174, "rad"}, {"odometry", 1.0, 1.0}};
  EXPECT_TRUE(warnings_about(usual).empty());
  const std::vector<AdaptedNoise> far = {
      {"range_2", 0.61, 0.2, "m"}, {"d", 2.53, 8.94, "px"}, {"odometry", 3.1, 1.0}};
  const std::vector<std::string> warnings = warnings_about(far);
  ASSERT_EQ(warnings.size(), 3U);
  EXPECT_NE(warnings[0].find("range_2 was adapted to 0.61 m where 0.2 m"), std::string::npos);
  EXPECT_NE(warnings[1].find("d was adapted to 2.53 px where 8.94 px"), std::string::npos);
  EXPECT_NE(warnings[1].find("common"), std::string::npos);
  EXPECT_NE(warnings[2].find("odometry was adapted to 3.1 where 1 was"), std::string::npos);
}
