#include <algorithm>
#include <cmath>
#include <optional>

#include <libslam/frontend/stereo_observation.hpp>

namespace libslam {

namespace {

using Observation = mrpt::obs::CObservationStereoImagesFeatures;

/// What calibration files round away: relative for lengths, radians for the rotation.
constexpr double kRounding = 1e-4;

bool undistorted(const mrpt::img::TCamera& camera) {
  return std::ranges::all_of(camera.dist, [](double k) { return k == 0.0; });
}

Eigen::Isometry3d isometry_of(const mrpt::poses::CPose3DQuat& pose) {
  const auto& q = pose.quat();
  return Eigen::Translation3d(pose.x(), pose.y(), pose.z()) *
         Eigen::Quaterniond(q.r(), q.x(), q.y(), q.z()).normalized();
}

/// Nothing if the pair is not rectified.
std::optional<StereoCamera> rectified_camera(const Observation& observation) {
  const auto &left = observation.cameraLeft, &right = observation.cameraRight;
  const Eigen::Isometry3d T_left_right = isometry_of(observation.rightCameraPose);
  StereoCamera camera;
  camera.fx = left.fx();
  camera.fy = left.fy();
  camera.cx = left.cx();
  camera.cy = left.cy();
  camera.width = static_cast<int>(left.ncols);
  camera.height = static_cast<int>(left.nrows);
  camera.baseline = T_left_right.translation().x();
  camera.T_robot_camera = isometry_of(observation.cameraPoseOnRobot);
  const bool finite = std::isfinite(camera.fx) && std::isfinite(camera.fy) &&
                      std::isfinite(camera.cx) && std::isfinite(camera.cy) &&
                      T_left_right.matrix().allFinite() &&
                      camera.T_robot_camera.matrix().allFinite();
  if (!finite || !(camera.fx > 0.0 && camera.fy > 0.0 && camera.baseline > 0.0))
    return std::nullopt;
  const double turn = Eigen::AngleAxisd(T_left_right.linear()).angle();
  const double aside = T_left_right.translation().tail<2>().norm() / camera.baseline;
  const Eigen::Vector4d difference(left.fx() - right.fx(), left.fy() - right.fy(),
                                   left.cx() - right.cx(), left.cy() - right.cy());
  const bool alike = difference.cwiseAbs().maxCoeff() <= kRounding * camera.fx;
  if (!alike || turn > kRounding || aside > kRounding || !undistorted(left) || !undistorted(right))
    return std::nullopt;
  return camera;
}

bool same(const StereoCamera& a, const StereoCamera& b) {
  return a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy && a.baseline == b.baseline &&
         a.width == b.width && a.height == b.height &&
         a.T_robot_camera.matrix() == b.T_robot_camera.matrix();
}

}  // namespace

StereoObservation::StereoObservation(const FrontendParameters& frontend,
                                     const StereoNoiseParameters& noise, std::string sensor_label,
                                     bool with_identities)
    : min_range_(frontend.min_range),
      max_range_(frontend.max_range),
      with_identities_(with_identities),
      sensor_label_(std::move(sensor_label)) {
  const double u_left = noise.variance(noise.sigma_u_left);
  const double u_right = noise.variance(noise.sigma_u_right);
  const double v_left = noise.variance(noise.sigma_v_left);
  const double v_right = noise.variance(noise.sigma_v_right);
  weight_left_ = v_right / (v_left + v_right);
  cov_ = Eigen::Matrix3d{{u_left, 0.0, u_left},
                         {0.0, v_left * v_right / (v_left + v_right), 0.0},
                         {u_left, 0.0, u_left + u_right}};
}

std::shared_ptr<const StereoCamera> StereoObservation::share(const StereoCamera& camera) {
  if (!camera_ || !same(*camera_, camera)) camera_ = std::make_shared<StereoCamera>(camera);
  return camera_;
}

void StereoObservation::add(const mrpt::obs::TStereoImageFeatures& point, int channel,
                            const std::shared_ptr<const StereoCamera>& camera,
                            FeatureBatch& batch) {
  const auto& [left, right] = point.pixels;
  const double v = weight_left_ * left.y + (1.0 - weight_left_) * right.y;
  const double d = static_cast<double>(left.x) - static_cast<double>(right.x);
  if (!std::isfinite(v) || !std::isfinite(d)) {
    ++unusable_;
    return;
  }
  const double depth = d > 0.0 ? camera->fx * camera->baseline / d : INFINITY;
  if (depth < min_range_ || depth > max_range_) return;
  Feature& feature = batch.emplace_back();
  feature.id = with_identities_ ? static_cast<std::int64_t>(point.ID) : kNoIdentity;
  feature.channel = channel;
  feature.z = Eigen::Vector3d(left.x, v, d);
  feature.cov = cov_;
  feature.camera = camera;
}

void StereoObservation::extract(const mrpt::obs::CSensoryFrame& frame,
                                std::vector<FeatureBatch>& batches) {
  batches.clear();
  for (const auto& any : frame) {
    const auto* observation = dynamic_cast<const Observation*>(any.get());
    if (observation == nullptr) continue;
    if (!sensor_label_.empty() && observation->sensorLabel != sensor_label_) continue;
    const auto camera = rectified_camera(*observation);
    if (!camera) {
      unusable_ += static_cast<std::int64_t>(observation->theFeatures.size());
      continue;
    }
    const auto shared = share(*camera);
    const int channel = channels_.of(observation->sensorLabel);
    FeatureBatch batch;
    batch.reserve(observation->theFeatures.size());
    for (const auto& point : observation->theFeatures) add(point, channel, shared, batch);
    if (!batch.empty()) batches.push_back(std::move(batch));
  }
}

}  // namespace libslam
