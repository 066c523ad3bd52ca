#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Dense>
#include <mrpt/obs/CObservationStereoImages.h>

#include <libslam/data/tag_points.hpp>
#include <libslam/frontend/fiducials.hpp>
#include <libslam/frontend/stereo_match.hpp>
#include <libslam/frontend/stereo_rectification.hpp>
#include <libslam/frontend/tag_detection.hpp>

namespace libslam {

namespace {

constexpr std::size_t kMostWarnings = 10;

/// Centre, then corners: as tag_point_id counts them.
std::array<Eigen::Vector2d, kPointsPerTag> points_of(const DetectedTag& tag) {
  const auto& c = tag.corners;
  const Eigen::Vector2d a = c[2] - c[0], b = c[3] - c[1];
  Eigen::Matrix2d along;
  along << a, -b;
  const double share = (along.inverse() * (c[1] - c[0]))[0];  // c0 + share a = c1 + ... b
  return {c[0] + share * a, c[0], c[1], c[2], c[3]};
}

}  // namespace

Fiducials::Fiducials(const FrontendParameters& parameters, std::string sensor_label)
    : parameters_(parameters),
      sensor_label_(std::move(sensor_label)),
      detector_(make_tag_detector(parameters.fiducials.family, parameters.fiducials.decimate)) {}

Fiducials::~Fiducials() = default;

void Fiducials::extract(const mrpt::obs::CSensoryFrame& frame, std::vector<FeatureBatch>& batches) {
  batches.clear();
  for (const auto& any : frame) {
    const auto* observation = dynamic_cast<const mrpt::obs::CObservationStereoImages*>(any.get());
    if (observation == nullptr) continue;
    if (!sensor_label_.empty() && observation->sensorLabel != sensor_label_) continue;
    FeatureBatch batch;
    try {
      const int channel = channels_.of(observation->sensorLabel);
      const RectifiedPair pair = rectifier_of(channel).rectify(*observation);
      const auto left = detector_->detect(pair.left), right = detector_->detect(pair.right);
      auto partner = right.begin();
      for (const DetectedTag& tag : left) {  // both in the order of their ids
        while (partner != right.end() && partner->id < tag.id) ++partner;
        if (partner != right.end() && partner->id == tag.id)
          add_points(tag, *partner, pair.camera, batch);
      }
      for (Feature& feature : batch) feature.channel = channel;
    } catch (const UnusableImages& defect) {
      ++unusable_;
      if (warnings_.size() < kMostWarnings) warnings_.emplace_back(defect.what());
    }
    if (!batch.empty()) batches.push_back(std::move(batch));
    observation->imageLeft.unload();
    observation->imageRight.unload();
  }
}

StereoRectifier& Fiducials::rectifier_of(int channel) {
  const auto k = static_cast<std::size_t>(channel);
  while (rectifiers_.size() <= k) rectifiers_.push_back(std::make_unique<StereoRectifier>());
  return *rectifiers_[k];
}

void Fiducials::add_points(const DetectedTag& left, const DetectedTag& right,
                           const std::shared_ptr<const StereoCamera>& camera, FeatureBatch& batch) {
  const FiducialParameters& p = parameters_.fiducials;
  const auto l = points_of(left), r = points_of(right);
  for (int k = 0; k < kPointsPerTag; ++k) {
    const bool centre = k == 0;
    if (centre ? p.points == "corners" : p.points == "centre") continue;
    const Eigen::Vector2d &on_left = l[static_cast<std::size_t>(k)],
                          &on_right = r[static_cast<std::size_t>(k)];
    StereoMatch match;
    match.z = {on_left.x(), 0.5 * (on_left.y() + on_right.y()), on_left.x() - on_right.x()};
    match.sigma = centre ? 0.5 * p.sigma_pixel : p.sigma_pixel;
    if (!match.z.allFinite() || std::abs(on_left.y() - on_right.y()) > p.row_tolerance ||
        !has_depth(match))
      continue;
    const double depth = triangulate(*camera, match.z).z();
    if (depth < parameters_.min_range || depth > parameters_.max_range) continue;
    Feature& feature = batch.emplace_back();
    feature.id = tag_point_id(left.id, k);
    feature.z = match.z;
    feature.cov = covariance_of(match);
    feature.camera = camera;
  }
}

}  // namespace libslam
