#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <Eigen/Dense>

#include <libslam/result/alignment.hpp>
#include <libslam/result/report_map_data.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {
namespace {

using Json = nlohmann::ordered_json;
using mrpt::math::TPose2D;

constexpr std::size_t kPathPoints = 5000;
constexpr std::size_t kPoseEllipses = 60;
constexpr std::size_t kLandmarks = 6000;

std::size_t stride_for(std::size_t count, std::size_t limit) {
  return std::max<std::size_t>(1, (count + limit - 1) / limit);
}

/// Every stride-th index and the last one.
template <typename Visit>
void for_each_strided(std::size_t count, std::size_t limit, Visit visit) {
  const std::size_t stride = stride_for(count, limit);
  for (std::size_t i = 0; i < count; i += stride) visit(i);
  if (count > 0 && (count - 1) % stride != 0) visit(count - 1);
}

Json polyline(std::size_t count, auto&& point_at) {
  Json xs = Json::array(), ys = Json::array();
  for_each_strided(count, kPathPoints, [&](std::size_t i) {
    const Eigen::Vector2d p = point_at(i);
    xs.push_back(short_number(p.x()));
    ys.push_back(short_number(p.y()));
  });
  return {{"x", xs}, {"y", ys}};
}

/// [x, y, xx, xy, yy] after the placement.
Json ellipse(const TPose2D& T, const Eigen::Vector2d& mean, const Eigen::Matrix2d& cov) {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(T.phi).toRotationMatrix();
  const Eigen::Matrix2d P = R * cov * R.transpose();
  const Eigen::Vector2d p = transform_point(T, mean);
  return {short_number(p.x()), short_number(p.y()), short_number(P(0, 0)), short_number(P(0, 1)),
          short_number(P(1, 1))};
}

Json landmark_list(const LandmarkMap& map, const TPose2D& T) {
  Json list = Json::array();
  for_each_strided(map.size(), kLandmarks, [&](std::size_t i) {
    const LandmarkEstimate& landmark = map.landmarks()[i];
    if (landmark.type != "point" || landmark.mean.size() < 2) return;
    Json entry = ellipse(T, landmark.mean.head<2>(), landmark.cov.topLeftCorner<2, 2>());
    entry.push_back(landmark.id);
    entry.push_back(landmark.times_seen);
    list.push_back(entry);
  });
  return list;
}

}  // namespace

Json short_number(double value) {
  if (!std::isfinite(value)) return nullptr;
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return std::strtod(text, nullptr);
}

Json make_map_data(const ReportInput& in, std::span<const EstimatedPose> path,
                   const std::optional<TPose2D>& placement) {
  const TPose2D T = placement.value_or(TPose2D(0, 0, 0));
  const GroundTruth truth = placement ? in.truth : GroundTruth();
  Json data = {{"ellipse_scale", std::sqrt(chi_square_quantile(0.95, 2))}};
  data["path"] = polyline(path.size(), [&](std::size_t i) -> Eigen::Vector2d {
    return transform_point(T, path[i].pose.head<2>());
  });
  data["truth"] = polyline(truth.path.poses.size(), [&](std::size_t i) -> Eigen::Vector2d {
    return truth.path.poses[i].head<2>();
  });
  data["truth_is_sparse"] = !truth.path.has_heading;
  data["pose_ellipses"] = Json::array();
  for_each_strided(path.size(), kPoseEllipses, [&](std::size_t i) {
    data["pose_ellipses"].push_back(
        ellipse(T, path[i].pose.head<2>(), path[i].cov.topLeftCorner<2, 2>()));
  });
  data["landmarks"] = landmark_list(in.map, T);
  data["true_landmarks"] = Json::array();
  for_each_strided(truth.landmarks.size(), kLandmarks, [&](std::size_t i) {
    const TrueLandmark& landmark = truth.landmarks[i];
    if (landmark.position.size() >= 2)
      data["true_landmarks"].push_back(
          {short_number(landmark.position.x()), short_number(landmark.position.y()), landmark.id});
  });
  return data;
}

}  // namespace libslam
