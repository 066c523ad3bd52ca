#include <fstream>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

#include <libslam/result/trajectory.hpp>

#include "sample_run.hpp"

namespace libslam {
namespace {

std::filesystem::path write(const sample::TemporaryFolder& folder, const std::string& text) {
  const auto file = folder.path() / "trajectory.csv";
  std::ofstream(file) << text;
  return file;
}

std::string text_of(const std::vector<StepRecord>& steps) {
  std::string text;
  append_trajectory_header(text, columns_of(steps.front()));
  for (const StepRecord& step : steps) append_trajectory_row(text, step);
  return text;
}

TEST(TrajectoryCsv, ReadsBackBitForBit) {
  const sample::TemporaryFolder folder("trajectory");
  const auto steps = sample::make_run(50, 7).steps;
  TrajectoryReader reader(write(folder, text_of(steps)));
  EXPECT_EQ(reader.columns().calibration, (std::vector<std::string>{"scale_left", "scale_right"}));
  StepRecord back;
  for (const StepRecord& step : steps) {
    ASSERT_TRUE(reader.next(back));
    EXPECT_EQ(back.time, step.time);  // 9 decimals identify a double of this size
    EXPECT_EQ(back.index, step.index);
    EXPECT_EQ(back.pose, step.pose);
    EXPECT_EQ(back.cov, Eigen::Matrix3d(step.cov.selfadjointView<Eigen::Upper>()));
    EXPECT_EQ(back.nis, step.nis);
    EXPECT_EQ(back.nis_dof, step.nis_dof);
    EXPECT_EQ(back.accepted, step.accepted);
    ASSERT_EQ(back.calibration.size(), 2u);
    EXPECT_EQ(back.calibration[1].mean, step.calibration[1].mean);
    EXPECT_EQ(back.calibration[1].sigma, step.calibration[1].sigma);
  }
  EXPECT_FALSE(reader.next(back));
}

// Scripts read these columns.
TEST(TrajectoryCsv, ColumnsOfAPlanarRunStayAsTheyAre) {
  StepRecord step;
  step.index = 3;
  step.time = 1.5;
  step.pose = {1, 2, 0.5};
  step.calibration = {{"scale", 1.25, 0.5, 1, 1, true}};
  EXPECT_EQ(text_of({step}),
            "time,step,x,y,phi,cov_xx,cov_xy,cov_xphi,cov_yy,cov_yphi,cov_phiphi,"
            "nis,nis_dof,accepted,gated,ambiguous,new_landmarks,scale,sigma_scale\n"
            "1.500000000,3,1,2,0.5,0,0,0,0,0,0,0,0,0,0,0,0,1.25,0.5\n");
}

TEST(TrajectoryCsv, AHalfWrittenLastLineIsNotRead) {
  const sample::TemporaryFolder folder("trajectory");
  std::string text = text_of(sample::make_run(5, 7).steps);
  text.resize(text.size() - 10);
  EXPECT_EQ(read_estimated_path(write(folder, text)).size(), 4u);
}

TEST(TrajectoryCsv, MalformedFilesNameFileAndLine) {
  const sample::TemporaryFolder folder("trajectory");
  const std::string good = text_of(sample::make_run(2, 7).steps);
  for (const std::string& text :
       {std::string(), std::string("a,b\n1,2\n"), good + "1,2,3\n", good + "\n"}) {
    try {
      read_estimated_path(write(folder, text));
      FAIL() << text;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("trajectory.csv:"), std::string::npos)
          << error.what();
    }
  }
  EXPECT_THROW(TrajectoryReader("/nonexistent/trajectory.csv"), std::runtime_error);
}

TEST(TrajectoryTum, QuaternionHasWLastAndNotationIsFixed) {
  std::string text;
  append_tum_row(text, 1234567890.5, {1e-7, -20000.25, std::numbers::pi / 2});
  EXPECT_EQ(text,
            "1234567890.500000000 0.000000100 -20000.250000000 0.000000000 0.000000000 0.000000000 "
            "0.707106781 0.707106781\n");
}

}  // namespace
}  // namespace libslam
