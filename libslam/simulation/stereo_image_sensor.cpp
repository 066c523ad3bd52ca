#include <algorithm>
#include <cmath>
#include <random>

#include <mrpt/obs/CObservationStereoImages.h>

#include <libslam/simulation/stereo_image_sensor.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

StereoImageSensor::StereoImageSensor(const Scenario& scenario, std::uint64_t seed)
    : parameters_(scenario.stereo_images),
      mount_(parameters_.pose, scenario.truth),
      noise_(scenario.faults, seed, RandomPurpose::kStereoImages, RandomPurpose::kStereoImages),
      renderer_(parameters_.wall_height) {
  camera_.ncols = static_cast<std::uint32_t>(parameters_.width);
  camera_.nrows = static_cast<std::uint32_t>(parameters_.height);
  camera_.setIntrinsicParamsFromValues(parameters_.focal_length_px, parameters_.focal_length_px,
                                       0.5 * (parameters_.width - 1),
                                       0.5 * (parameters_.height - 1));
  // Camera axes in the robot frame: Z forward, X right, Y down.
  const mrpt::poses::CPose3D axes(0.0, 0.0, 0.0, -kPi / 2, 0.0, -kPi / 2);
  logged_pose_ = mrpt::poses::CPose3DQuat(mount_.logged_pose(parameters_.camera_height) + axes);
}

mrpt::obs::CObservation::Ptr StereoImageSensor::observe(const SensorScene& scene) {
  auto observation = mrpt::obs::CObservationStereoImages::Create();
  observation->timestamp = scene.stamp;
  observation->sensorLabel = "stereo_images";
  observation->leftCamera = observation->rightCamera = camera_;
  observation->cameraPose = logged_pose_;
  observation->rightCameraPose =
      mrpt::poses::CPose3DQuat(mrpt::poses::CPose3D(parameters_.baseline, 0.0, 0.0, 0.0, 0.0, 0.0));
  std::vector<TagPlate> plates;
  for (std::size_t i = 0; i < scene.ids.size(); ++i)
    if (scene.ids[i] >= 0 && scene.ids[i] < kTags)
      plates.push_back(
          make_plate(scene.ids[i], scene.p_world[i], parameters_.tag_size, scene.walls));
  const Eigen::Vector3d left = compose_poses(scene.T_world_robot, mount_.actual);
  const Eigen::Vector3d right = compose_poses(left, {0.0, -parameters_.baseline, 0.0});
  RandomStream random = noise_.stream(scene);
  observation->imageLeft = take_image(scene, left, plates, random);
  observation->imageRight = take_image(scene, right, plates, random);
  observation->hasImageRight = true;
  return observation;
}

mrpt::img::CImage StereoImageSensor::take_image(const SensorScene& scene,
                                                const Eigen::Vector3d& T_world_camera,
                                                const std::vector<TagPlate>& plates,
                                                RandomStream& random) {
  const RenderedCamera view{
      T_world_camera, parameters_.camera_height, camera_.fx(),      camera_.cx(),
      camera_.cy(),   parameters_.width,         parameters_.height};
  const std::vector<float> gray = renderer_.render(view, scene.walls, plates);
  std::normal_distribution<double> normal;
  mrpt::img::CImage image(parameters_.width, parameters_.height, mrpt::img::CH_GRAY);
  for (int row = 0; row < parameters_.height; ++row) {
    auto* out = image.ptrLine<std::uint8_t>(static_cast<unsigned>(row));
    for (int column = 0; column < parameters_.width; ++column) {
      const double value = gray[static_cast<std::size_t>(row * parameters_.width + column)] +
                           parameters_.sigma_gray * normal(random);
      out[column] = static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
    }
  }
  return image;
}

}  // namespace libslam
