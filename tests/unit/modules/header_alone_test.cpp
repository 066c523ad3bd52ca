// The header stands alone: its forward declarations need no include of the user before it.
#include <gtest/gtest.h>

#include <libslam/modules/range_bearing_slam_2d.hpp>

namespace libslam {
namespace {

TEST(RangeBearingSlam2dHeader, StandsAlone) {
  RangeBearingSlam2D slam;
  EXPECT_EQ(slam.getLoggerName(), "RangeBearingSlam2D");
}

}  // namespace
}  // namespace libslam
