// A simulated head (the one of the example) localizes in a surveyed map.

#include <cmath>
#include <examples/stereo_localization/simulated_head.hpp>
#include <fstream>
#include <string>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPose3DQuatPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <libslam/io/input_error.hpp>
#include <libslam/modules/pose_pdf.hpp>
#include <libslam/modules/stereo_localization.hpp>

#include "support/config_error_message.hpp"
#include "support/program_run.hpp"

namespace libslam {
namespace {

using mrpt::poses::CPose3D;
using mrpt::poses::CPose3DPDFGaussian;

class HeadInAMap : public test::ProgramTest {
 protected:
  HeadInAMap() {
    std::ostringstream map;
    map << "id,x,y,z\n";
    for (std::size_t i = 0; i < head_.landmarks.size(); ++i)
      map << i << ',' << head_.landmarks[i].x() << ',' << head_.landmarks[i].y() << ','
          << head_.landmarks[i].z() << '\n';
    map_ = write("map.csv", map.str());
    localization_.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    configure(localization_);
  }

  void configure(StereoLocalization& localization) const {
    Parameters& p = localization.options.parameters;
    p.map.file = map_;
    p.measurement.stereo.sigma_pixel = SimulatedHead::kSigmaPixel;
    p.motion.twist.sigma_speed_x = p.motion.twist.sigma_speed_y = SimulatedHead::kSigmaSpeed;
    p.motion.twist.sigma_speed_z = 0.01;
    p.motion.twist.sigma_rate_x = p.motion.twist.sigma_rate_y = SimulatedHead::kSigmaRate;
    p.motion.twist.sigma_rate_z = SimulatedHead::kSigmaRate;
  }

  /// Position, then rotation vector, true minus estimated, in the world frame.
  Eigen::Matrix<double, 6, 1> error() const {
    CPose3DPDFGaussian pose;
    localization_.getCurrentPose(pose);
    const SpatialEstimate estimate = from_pose_pdf(pose);
    const Eigen::AngleAxisd turn(head_.pose.linear() *
                                 estimate.pose.rotation.toRotationMatrix().transpose());
    Eigen::Matrix<double, 6, 1> difference;
    difference << head_.pose.translation() - estimate.pose.position, turn.angle() * turn.axis();
    return difference;
  }
  double nees() const {
    CPose3DPDFGaussian pose;
    localization_.getCurrentPose(pose);
    const auto e = error();
    return e.dot(from_pose_pdf(pose).cov.ldlt().solve(e));
  }

  void drive(StereoLocalization& localization, int frames) {
    for (int i = 0; i < frames; ++i) {
      for (int k = 0; k < 2; ++k)
        for (const auto& reading : head_.move()) localization.processObservation(reading);
      localization.processObservation(head_.look());
    }
  }

  SimulatedHead head_{7};
  std::string map_;
  StereoLocalization localization_;
};

TEST_F(HeadInAMap, FindsItselfFromARoughStart) {
  CPose3DPDFGaussian start(CPose3D(0.3, -0.3, 0.2, 0.1, -0.1, 0.1));
  start.cov.setDiagonal(6, 0.03);
  start.cov(0, 0) = start.cov(1, 1) = start.cov(2, 2) = 0.25;
  localization_.initialize(&start);
  CPose3DPDFGaussian pose;
  localization_.getCurrentPose(pose);
  EXPECT_LT((pose.cov.asEigen() - start.cov.asEigen()).norm(), 1e-9);
  drive(localization_, 20);
  double sum = 0.0;
  constexpr int kFrames = 200;
  for (int i = 0; i < kFrames; ++i) {
    drive(localization_, 1);
    sum += nees();
    ASSERT_GT(localization_.getLastStep().accepted, 0) << i;
    // Measured: 7 mm and 1.1 mrad rms; the largest of 200 is some four times that.
    ASSERT_LT(error().head<3>().norm(), 0.04) << i;
    ASSERT_LT(error().tail<3>().norm(), 0.006) << i;
  }
  // 6 degrees of freedom, correlated over about ten frames, so some twenty independent samples:
  // 6 +- 4 * sqrt(12 / 20).
  EXPECT_NEAR(sum / kFrames, 6.0, 3.1);
  EXPECT_EQ(localization_.getLandmarks().size(), head_.landmarks.size());
}

TEST_F(HeadInAMap, GivesTheSamePoseInBothForms) {
  localization_.initialize();
  drive(localization_, 30);
  CPose3DPDFGaussian angles;
  mrpt::poses::CPose3DQuatPDFGaussian quaternion;
  localization_.getCurrentPose(angles);
  localization_.getCurrentPose(quaternion);
  const CPose3DPDFGaussian back(quaternion);
  EXPECT_LT((back.mean.asVectorVal().asEigen() - angles.mean.asVectorVal().asEigen()).norm(), 1e-9);
  EXPECT_LT((back.cov.asEigen() - angles.cov.asEigen()).norm(), 1e-9);
  EXPECT_GT(angles.mean.norm(), 1.0);
}

TEST_F(HeadInAMap, GoesOnFromASavedState) {
  localization_.initialize();
  drive(localization_, 20);
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  localization_.saveState(archive);
  stream.Seek(0);
  StereoLocalization other;
  configure(other);
  other.loadState(archive);
  // Another drive of the same head gives both the same pairs of action and frame.
  for (int i = 0; i < 10; ++i) {
    head_.move();
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(head_.look());
    localization_.processActionObservation(nullptr, frame);
    other.processActionObservation(nullptr, frame);
  }
  CPose3DPDFGaussian a, b;
  localization_.getCurrentPose(a);
  other.getCurrentPose(b);
  EXPECT_EQ(a.mean.x(), b.mean.x());
  EXPECT_EQ(a.cov(5, 2), b.cov(5, 2));
  EXPECT_EQ(localization_.getLandmarks().size(), other.getLandmarks().size());
}

TEST_F(HeadInAMap, MakesAMapOnDemand) {
  StereoLocalization mapper;
  configure(mapper);
  mapper.options.parameters.map.file.clear();
  mapper.initialize();
  drive(mapper, 60);
  EXPECT_GT(mapper.getLandmarks().size(), 20U);
  mapper.saveMap(path("made.slammap"));
  localization_.options.parameters.map.file = path("made.slammap");
  localization_.initialize();
  EXPECT_EQ(localization_.getLandmarks().size(), mapper.getLandmarks().size());
}

TEST_F(HeadInAMap, SaysWhatIsMissing) {
  EXPECT_THROW(localization_.processObservation(head_.look()), std::logic_error);
  localization_.options.parameters.map.file = path("none.csv");
  EXPECT_THROW(localization_.initialize(), InputError);
}

TEST(StereoLocalizationOptions, ComeFromAnIniFile) {
  StereoLocalization localization;
  localization.loadOptions(mrpt::config::CConfigFileMemory(
      std::string("[StereoLocalization]\nmap_file = a.csv\nmap_sigma = 0.02\nadd_landmarks = true\n"
                  "verbosity_level = ERROR\n[libslam.measurement.stereo]\nsigma_pixel = 2\n")));
  const Parameters& p = localization.options.parameters;
  EXPECT_EQ(p.map.file, "a.csv");
  EXPECT_EQ(p.map.sigma, 0.02);
  EXPECT_EQ(p.map.mode, "continue");
  EXPECT_EQ(p.measurement.stereo.sigma_pixel, 2.0);
  EXPECT_EQ(p.motion.model, "body_twist");
  EXPECT_EQ(test::config_error_message([&] {
              localization.loadOptions(mrpt::config::CConfigFileMemory(
                  std::string("[StereoLocalization]\nmap_sigma = -1\n")));
            }).find("[StereoLocalization] map_sigma: "),
            0U);
}

class StereoExample : public test::ProgramTest {};

TEST_F(StereoExample, Localizes) {
  const test::Outcome outcome = run(std::string(LIBSLAM_EXAMPLE_STEREO) + " " + path("map.csv"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream text(outcome.out);
  int frames = 0;
  double metres = 0.0, degrees = 0.0;
  ASSERT_TRUE(text >> frames >> metres >> degrees) << outcome.out;
  EXPECT_EQ(frames, 500);
  // Measured: .0074 m and .065 degrees, the rough start included.
  EXPECT_LT(metres, 0.02);
  EXPECT_LT(degrees, 0.2);
}

}  // namespace
}  // namespace libslam
