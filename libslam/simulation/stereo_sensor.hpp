#pragma once
// Pixels of landmarks in a rectified stereo camera -> CObservationStereoImagesFeatures.
//
//   u_l = c_x + f X / Z,  v = c_y + f Y / Z,  u_r = u_l - f b / Z
//
// Camera frame: X right, Y down, Z along the axis, which points where the sensor does. f
// focal_length_px [px], b baseline [m], (c_x, c_y) the centre of the image.

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3DQuat.h>

#include <libslam/simulation/sensor_noise.hpp>

namespace libslam {

/// Sees the landmarks in front of it within range whose pixels, noise included, lie in both images
/// and that no wall hides. The four coordinates of a landmark have independent noise. Without
/// identities in the log, features are numbered anew in every observation.
class StereoSensor final : public SimulatedSensor {
 public:
  StereoSensor(const Scenario& scenario, std::uint64_t seed);
  mrpt::obs::CObservation::Ptr observe(const SensorScene& scene) override;

 private:
  /// Left u, left v, right u, right v [px].
  using Pixels = Eigen::Vector4d;

  Pixels project(const Eigen::Vector3d& p_camera) const;
  void disturb(Pixels& pixels, const SensorScene& scene, std::size_t landmark, double depth) const;
  bool in_view(const Pixels& pixels) const;

  StereoSensorParameters parameters_;
  SensorMount mount_;
  SensorNoise noise_;
  bool identities_;
  mrpt::img::TCamera camera_;
  mrpt::poses::CPose3DQuat logged_pose_;
};

}  // namespace libslam
