#include <libslam/simulation/sensor_noise.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

SensorMount::SensorMount(const SensorPoseParameters& pose, const TruthParameters& truth)
    : logged(pose.x, pose.y, to_radians(pose.heading_deg)),
      actual(logged + Eigen::Vector3d(truth.sensor_x, truth.sensor_y,
                                      to_radians(truth.sensor_heading_deg))) {}

mrpt::poses::CPose3D SensorMount::logged_pose(double height) const {
  return {logged.x(), logged.y(), height, logged.z(), 0.0, 0.0};
}

double SensorNoise::factor(double elapsed, double distance) const {
  double factor = 1.0;
  const NoiseStepParameters& step = faults_.noise_step;
  if (step.enabled && elapsed >= step.begin_s && elapsed < step.end_s) factor *= step.factor;
  if (faults_.distance_noise.enabled)
    factor *= 1.0 + faults_.distance_noise.growth_per_m * distance;
  return factor;
}

}  // namespace libslam
