#pragma once
// Rendered images of a rectified stereo camera -> CObservationStereoImages.

#include <mrpt/img/CImage.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3DQuat.h>

#include <libslam/simulation/scene_renderer.hpp>
#include <libslam/simulation/sensor_noise.hpp>

namespace libslam {

/// Landmarks with the numbers of tags (kTags) carry plates with them. Gray values have independent
/// noise; faults of `noise_step` and `distance_noise` do not concern them.
class StereoImageSensor final : public SimulatedSensor {
 public:
  StereoImageSensor(const Scenario& scenario, std::uint64_t seed);
  mrpt::obs::CObservation::Ptr observe(const SensorScene& scene) override;

 private:
  mrpt::img::CImage take_image(const SensorScene& scene, const Eigen::Vector3d& T_world_camera,
                               const std::vector<TagPlate>& plates, RandomStream& random);

  StereoImagesParameters parameters_;
  SensorMount mount_;
  SensorNoise noise_;
  SceneRenderer renderer_;
  mrpt::img::TCamera camera_;
  mrpt::poses::CPose3DQuat logged_pose_;
};

}  // namespace libslam
