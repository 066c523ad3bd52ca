// StereoLocalization on images: a simulated robot in rooms whose tags are surveyed.

#include <cmath>
#include <fstream>
#include <string>
#include <support/temporary_directory.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <libslam/modules/pose_pdf.hpp>
#include <libslam/modules/stereo_localization.hpp>
#include <libslam/pipeline/simulation.hpp>
#include <libslam/simulation/tag_plate.hpp>

namespace libslam {
namespace {

using mrpt::obs::CObservationStereoImages;
using mrpt::poses::CPose3D;
using mrpt::poses::CPose3DPDFGaussian;

class ImagesInAMap : public ::testing::Test {
 protected:
  ImagesInAMap() {
    scenario_ = load_scenario(LIBSLAM_SOURCE_DIR "/config/sim_stereo.yaml");
    scenario_.drive.max_duration_s = 20.0;
    simulator_ = make_simulator(scenario_, 3);
    const std::string map = (directory_.path() / "map.csv").string();
    std::ofstream file(map);
    file << "id,x,y,z\n";
    file.precision(12);
    const auto survey = [&](const std::vector<TrueLandmark>& points) {
      for (const TrueLandmark& p : points)
        file << p.id << ',' << p.position.x() << ',' << p.position.y() << ',' << p.position.z()
             << '\n';
    };
    survey(simulator_->landmarks());
    survey(tag_corners(simulator_->world(), scenario_.stereo_images.tag_size));
    file.close();
    localization_.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    localization_.options.parameters = nominal_filter(scenario_);
    // The wheels of the scenario are not what the robot believes.
    localization_.options.parameters.calibration.scale_left.enabled = true;
    localization_.options.parameters.calibration.scale_right.enabled = true;
    // The first tag is seen half a metre beside the true place: one linearization leads to two
    // sigma from the truth, several to less than one.
    localization_.options.parameters.filter.update_linearizations = 10;
    localization_.options.parameters.map.file = map;
    localization_.options.parameters.map.mode = "localize";
  }

  /// Half a metre and 6 degrees beside `T_world_robot`.
  void start_beside(const Eigen::Vector3d& T_world_robot) {
    CPose3DPDFGaussian start(CPose3D(T_world_robot.x() + 0.4, T_world_robot.y() - 0.3, 0.0,
                                     T_world_robot.z() + 0.1, 0.0, 0.0));
    start.cov.setZero();
    start.cov(0, 0) = start.cov(1, 1) = 0.25;
    start.cov(3, 3) = 0.03;
    localization_.initialize(&start);
  }

  test::TemporaryDirectory directory_;
  Scenario scenario_;
  std::unique_ptr<Simulator> simulator_;
  StereoLocalization localization_;
};

TEST_F(ImagesInAMap, FindsItselfByTheTagsItSees) {
  int pairs = 0, used = 0, judged = 0;
  double sum = 0.0, worst = 0.0;
  while (const auto step = simulator_->next()) {
    if (!step->step.action && pairs == 0) start_beside(step->T_world_robot);
    localization_.processActionObservation(step->step.action, step->step.frame);
    if (!step->step.frame) continue;
    ASSERT_TRUE(step->step.frame->getObservationByClass<CObservationStereoImages>());
    ++pairs;
    used += localization_.getLastStep().accepted > 0 ? 1 : 0;
    if (used == 0) continue;  // no tag so far
    ++judged;
    CPose3DPDFGaussian pose;
    localization_.getCurrentPose(pose);
    const double error = std::hypot(pose.mean.x() - step->T_world_robot.x(),
                                    pose.mean.y() - step->T_world_robot.y());
    sum += error * error;
    worst = std::max(worst, error);
  }
  EXPECT_EQ(pairs, 101);
  EXPECT_GT(used, 40);
  // Measured: 19 mm and 40 mm over 30 s, 50 of 100 pairs with a tag. Wheels alone turn away by .04
  // rad/s.
  EXPECT_LT(std::sqrt(sum / judged), 0.04);
  EXPECT_LT(worst, 0.1);
  EXPECT_EQ(localization_.getLandmarks().size(), 24U * 5U);
}

TEST_F(ImagesInAMap, GoesOnWithoutAnImageThatCannotBeUsed) {
  const auto first = simulator_->next();
  start_beside(first->T_world_robot);
  auto observation = first->step.frame->getObservationByClass<CObservationStereoImages>();
  auto blind = CObservationStereoImages::Create(*observation);
  blind->hasImageRight = false;
  auto frame = mrpt::obs::CSensoryFrame::Create();
  frame->insert(blind);
  localization_.processActionObservation(nullptr, frame);
  EXPECT_EQ(localization_.getLastStep().accepted, 0);
  localization_.processObservation(observation);
  EXPECT_EQ(localization_.getLandmarks().size(), 24U * 5U);
}

}  // namespace
}  // namespace libslam
