#include <cmath>

#include <mrpt/obs/CObservationStereoImagesFeatures.h>

#include <libslam/simulation/stereo_sensor.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

using mrpt::obs::CObservationStereoImagesFeatures;

StereoSensor::StereoSensor(const Scenario& scenario, std::uint64_t seed)
    : parameters_(scenario.stereo),
      mount_(parameters_.pose, scenario.truth),
      noise_(scenario.faults, seed, RandomPurpose::kStereo, RandomPurpose::kStereoOutlier),
      identities_(scenario.log.identities) {
  camera_.ncols = static_cast<std::uint32_t>(parameters_.width);
  camera_.nrows = static_cast<std::uint32_t>(parameters_.height);
  camera_.setIntrinsicParamsFromValues(parameters_.focal_length_px, parameters_.focal_length_px,
                                       0.5 * parameters_.width, 0.5 * parameters_.height);
  // Camera axes in the robot frame: Z forward, X right, Y down.
  const mrpt::poses::CPose3D axes(0.0, 0.0, 0.0, -kPi / 2, 0.0, -kPi / 2);
  logged_pose_ = mrpt::poses::CPose3DQuat(mount_.logged_pose(parameters_.camera_height) + axes);
}

StereoSensor::Pixels StereoSensor::project(const Eigen::Vector3d& p_camera) const {
  const double scale = parameters_.focal_length_px / p_camera.z();
  const double u = camera_.cx() + scale * p_camera.x(), v = camera_.cy() + scale * p_camera.y();
  return {u, v, u - scale * parameters_.baseline, v};
}

void StereoSensor::disturb(Pixels& pixels, const SensorScene& scene, std::size_t landmark,
                           double depth) const {
  RandomStream random = noise_.stream(scene, landmark);
  std::normal_distribution<double> normal;
  const double sigma = noise_.factor(scene.elapsed, depth) * parameters_.sigma_pixel;
  for (double& pixel : pixels) pixel += sigma * normal(random);
  RandomStream outlier = noise_.outlier_stream(scene, landmark);
  if (!noise_.draw_outlier(outlier)) return;
  std::uniform_real_distribution<double> uniform;
  for (Eigen::Index i = 0; i < pixels.size(); ++i)
    pixels[i] = uniform(outlier) * (i % 2 == 0 ? parameters_.width : parameters_.height);
}

bool StereoSensor::in_view(const Pixels& pixels) const {
  const Eigen::Array4d size(parameters_.width, parameters_.height, parameters_.width,
                            parameters_.height);
  return (pixels.array() >= 0.0).all() && (pixels.array() < size).all();
}

mrpt::obs::CObservation::Ptr StereoSensor::observe(const SensorScene& scene) {
  auto observation = CObservationStereoImagesFeatures::Create();
  observation->timestamp = scene.stamp;
  observation->sensorLabel = "stereo";
  observation->cameraLeft = observation->cameraRight = camera_;
  observation->rightCameraPose =
      mrpt::poses::CPose3DQuat(mrpt::poses::CPose3D(parameters_.baseline, 0.0, 0.0, 0.0, 0.0, 0.0));
  observation->cameraPoseOnRobot = logged_pose_;
  const Eigen::Vector3d T_world_sensor = compose_poses(scene.T_world_robot, mount_.actual);
  for (std::size_t i = 0; i < scene.ids.size(); ++i) {
    const Eigen::Vector2d p = transform_back(T_world_sensor, scene.p_world[i].head<2>());
    const Eigen::Vector3d p_camera(-p.y(), parameters_.camera_height - scene.p_world[i].z(), p.x());
    if (!(p_camera.z() > 0.0) || p_camera.z() > parameters_.max_range) continue;
    Pixels pixels = project(p_camera);
    if (!in_view(pixels)) continue;
    if (!scene.walls.sees(T_world_sensor.head<2>(), scene.p_world[i].head<2>())) continue;
    disturb(pixels, scene, i, p_camera.z());
    if (!in_view(pixels)) continue;
    const auto number = identities_ ? static_cast<unsigned>(scene.ids[i])
                                    : static_cast<unsigned>(observation->theFeatures.size());
    const Eigen::Vector4f q = pixels.cast<float>();
    observation->theFeatures.push_back(
        {{mrpt::img::TPixelCoordf(q[0], q[1]), mrpt::img::TPixelCoordf(q[2], q[3])}, number});
  }
  return observation;
}

}  // namespace libslam
