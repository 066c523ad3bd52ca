#include <libslam/config/rules/rules.hpp>

namespace libslam {
namespace {

/// The landmarks are given: none is added or removed.
bool localizes_in_map(const Parameters& p) {
  return !p.map.file.empty() && p.map.mode == "localize";
}

bool in_space(const Parameters& p) {
  return p.motion.model == "body_twist" || p.motion.model == "constant_twist";
}

void check_velocity_source(const Parameters& p, Conflicts& conflicts) {
  const bool measured = p.motion.model == "body_twist", twist = p.input.odometry == "twist";
  if (measured != twist) {
    conflicts.push_back(
        {{"input.odometry", "motion.model"}, "twist drives body_twist, and nothing else does"});
  }
  if (p.motion.model == "constant_twist" && p.input.odometry != "none") {
    conflicts.push_back({{"input.odometry", "motion.model"},
                         "constant_twist estimates the velocity itself; set odometry to none"});
  }
}

void check_space(const Parameters& p, Conflicts& conflicts) {
  if (p.filter.delayed_pose_distance > 0.0) {
    conflicts.push_back({{"filter.delayed_pose_distance", "motion.model"},
                         "poses of the past are kept in the plane alone"});
  }
  if (p.measurement.model != "stereo_point" || p.measurement.stereo.landmark_dimension != 3) {
    conflicts.push_back(
        {{"motion.model", "measurement.model", "measurement.stereo.landmark_dimension"},
         "a robot in space sees landmarks with three coordinates: stereo_point with 3"});
  }
}

}  // namespace

void check_spatial(const Parameters& p, Conflicts& conflicts) {
  check_velocity_source(p, conflicts);
  if (in_space(p)) {
    check_space(p, conflicts);
  }
  const bool points = p.measurement.model == "stereo_point";
  const std::string& source = p.frontend.source;
  if (points != (source == "stereo_points" || source == "stereo_images" || source == "fiducials")) {
    conflicts.push_back({{"measurement.model", "frontend.source"},
                         "stereo_point measures stereo_points, stereo_images and fiducials, and "
                         "nothing else does"});
  }
  const bool planar_map = !points || p.measurement.stereo.landmark_dimension == 2;
  const auto& implied = p.policies.implied_input;
  if (implied.enabled && !(implied.probability > 0.0 && implied.probability < 1.0)) {
    conflicts.push_back(
        {{"policies.implied_input.probability"}, "a test at 0 rejects everything, at 1 nothing"});
  }
  if (implied.enabled && p.association.forget_after == 0 && !localizes_in_map(p)) {
    conflicts.push_back({{"policies.implied_input.enabled", "association.forget_after"},
                         "an observation that asks for an impossible motion makes all landmarks "
                         "start anew, and a map that is to last would be lost; forget landmarks, "
                         "or localize in a given map"});
  }
  if (p.filter.linearization != "estimate" && !planar_map) {
    conflicts.push_back({{"filter.linearization", "measurement.stereo.landmark_dimension"},
                         "another point than the estimate is derived for planar landmarks only"});
  }
}

}  // namespace libslam
