#pragma once
// What a program does that takes a map builder of MRPT, and the demo log for it.

#include <string>
#include <vector>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/slam/CMetricMapBuilder.h>

#include <libslam/config/parameters.hpp>
#include <libslam/io/rawlog_player.hpp>

namespace libslam::test {

inline const std::string kDemo = "/usr/share/mrpt/datasets/kf-slam_demo.rawlog";

/// The first `count` steps that show something.
inline std::vector<LogStep> read_log(const std::string& file, std::size_t count = 100000) {
  RawlogPlayer player(file);
  std::vector<LogStep> steps;
  while (steps.size() < count) {
    auto step = player.next();
    if (!step) break;
    if (step->frame) steps.push_back(std::move(*step));
  }
  return steps;
}

inline mrpt::poses::CPose3DPDFGaussian pose_of(const mrpt::slam::CMetricMapBuilder& builder) {
  mrpt::poses::CPose3DPDFGaussian pose;
  pose.copyFrom(*builder.getCurrentPoseEstimation());
  return pose;
}

/// Feeds steps [from, to) and returns the pose after each.
inline std::vector<mrpt::poses::CPose3DPDFGaussian> run(mrpt::slam::CMetricMapBuilder& builder,
                                                        const std::vector<LogStep>& steps,
                                                        std::size_t from = 0,
                                                        std::size_t to = 100000) {
  std::vector<mrpt::poses::CPose3DPDFGaussian> path;
  for (std::size_t i = from; i < std::min(to, steps.size()); ++i) {
    mrpt::obs::CActionCollection action;
    if (steps[i].action) action = *steps[i].action;
    builder.processActionObservation(action, *steps[i].frame);
    path.push_back(pose_of(builder));
  }
  return path;
}

/// The demo's sensor as MRPT's own configuration of it says.
inline Parameters demo_parameters() {
  Parameters p;
  p.measurement.noise = "configured";
  p.measurement.sigma_range = 0.03;
  p.measurement.sigma_bearing_deg = 0.1;
  return p;
}

}  // namespace libslam::test
