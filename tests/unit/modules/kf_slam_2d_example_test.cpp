// One program, two types, one result.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "support/temporary_directory.hpp"

namespace libslam {
namespace {

const std::string kDemo = "/usr/share/mrpt/datasets/kf-slam_demo.rawlog";
const std::string kIni = "/usr/share/mrpt/config_files/kf-slam/EKF-SLAM_test_2d.ini";

struct Result {
  double x = 0.0, y = 0.0, phi = 0.0;
  int landmarks = 0;
};

Result run(const std::string& program, const test::TemporaryDirectory& directory) {
  const std::string out = (directory.path() / "out").string();
  const std::string map = (directory.path() / "map.m").string();
  const std::string command = program + " " + kDemo + " " + kIni + " " + map + " >" + out;
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  EXPECT_GT(std::filesystem::file_size(map), 0U);
  Result result;
  std::ifstream text(out);
  EXPECT_TRUE(text >> result.x >> result.y >> result.phi >> result.landmarks) << command;
  return result;
}

TEST(KfSlam2dExample, GivesTheSameResultWithBothClasses) {
  const test::TemporaryDirectory ours_directory, stock_directory;
  const Result ours = run(LIBSLAM_EXAMPLE, ours_directory);
  const Result stock = run(LIBSLAM_EXAMPLE_MRPT, stock_directory);
  EXPECT_NEAR(ours.x, stock.x, 1e-6);
  EXPECT_NEAR(ours.y, stock.y, 1e-6);
  EXPECT_NEAR(ours.phi, stock.phi, 1e-6);
  EXPECT_EQ(ours.landmarks, 70);
  EXPECT_EQ(stock.landmarks, 70);
}

}  // namespace
}  // namespace libslam
