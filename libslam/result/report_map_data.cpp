#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <Eigen/Dense>

#include <libslam/map/line_segment.hpp>
#include <libslam/result/alignment.hpp>
#include <libslam/result/report_map_data.hpp>
#include <libslam/result/spatial_alignment.hpp>
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

/// What is drawn of an uncertain point.
struct Spot {
  Eigen::Vector2d mean;
  Eigen::Matrix2d cov;
};

Json ellipse(const Spot& spot) {
  return {short_number(spot.mean.x()), short_number(spot.mean.y()), short_number(spot.cov(0, 0)),
          short_number(spot.cov(0, 1)), short_number(spot.cov(1, 1))};
}

/// Everything of a planar run in the frame of the truth.
struct PlanarView {
  std::vector<EstimatedPose> path;
  const Trajectory& truth;
  TPose2D T;

  Spot spot(const Eigen::Vector2d& mean, const Eigen::Matrix2d& cov) const {
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(T.phi).toRotationMatrix();
    return {transform_point(T, mean), R * cov * R.transpose()};
  }
  Spot pose(std::size_t i) const {
    return spot(path[i].pose.head<2>(), path[i].cov.topLeftCorner<2, 2>());
  }
  Spot landmark(const LandmarkEstimate& landmark) const {
    return spot(landmark.mean.head<2>(), landmark.cov.topLeftCorner<2, 2>());
  }
  Eigen::Vector2d true_pose(std::size_t i) const { return truth.poses[i].head<2>(); }
  Eigen::Vector2d true_point(const Eigen::VectorXd& point) const { return point.head<2>(); }
};

/// Everything of a run in space in the frame of the truth, seen along an axis.
struct SpatialView {
  std::vector<SpatialEstimate> path;
  const Trajectory& truth;
  Eigen::Isometry3d T;
  Eigen::Index vertical;  ///< coordinate in the place of y

  Eigen::Vector2d seen(const Eigen::Vector3d& point) const { return {point.x(), point[vertical]}; }
  Spot spot(const Eigen::Vector3d& mean, const Eigen::Matrix3d& cov) const {
    const Eigen::Matrix3d P = T.linear() * cov * T.linear().transpose();
    Spot drawn{seen(T * mean), {}};
    drawn.cov << P(0, 0), P(0, vertical), P(0, vertical), P(vertical, vertical);
    return drawn;
  }
  Spot pose(std::size_t i) const {
    return spot(path[i].pose.position, path[i].cov.topLeftCorner<3, 3>());
  }
  Spot landmark(const LandmarkEstimate& landmark) const {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();
    const Eigen::Index n = std::min<Eigen::Index>(3, landmark.mean.size());
    mean.head(n) = landmark.mean.head(n);
    cov.topLeftCorner(n, n) = landmark.cov.topLeftCorner(n, n);
    return spot(mean, cov);
  }
  Eigen::Vector2d true_pose(std::size_t i) const { return seen(truth.spatial[i].position); }
  Eigen::Vector2d true_point(const Eigen::VectorXd& point) const {
    return seen({point.x(), point.y(), point.size() > 2 ? point.z() : 0.0});
  }
};

Json landmark_list(const LandmarkMap& map, const auto& view) {
  Json list = Json::array();
  for_each_strided(map.size(), kLandmarks, [&](std::size_t i) {
    const LandmarkEstimate& landmark = map.landmarks()[i];
    if (landmark.type != "point" || landmark.mean.size() < 2) return;
    Json entry = ellipse(view.landmark(landmark));
    entry.push_back(landmark.id);
    entry.push_back(landmark.times_seen);
    list.push_back(entry);
  });
  return list;
}

Json true_landmark_list(const std::vector<TrueLandmark>& landmarks, const auto& view) {
  Json list = Json::array();
  for_each_strided(landmarks.size(), kLandmarks, [&](std::size_t i) {
    if (landmarks[i].position.size() < 2) return;
    const Eigen::Vector2d point = view.true_point(landmarks[i].position);
    list.push_back({short_number(point.x()), short_number(point.y()), landmarks[i].id});
  });
  return list;
}

/// The lines of which a part was seen: their ends, id, times seen. In the plane.
Json wall_list(const LandmarkMap& map, const TPose2D& T_truth_filter) {
  Json list = Json::array();
  for (const LandmarkEstimate& landmark : map) {
    const auto wall = segment_of(landmark);
    if (!wall || list.size() == kLandmarks) continue;
    const Eigen::Vector2d from = transform_point(T_truth_filter, wall->from);
    const Eigen::Vector2d to = transform_point(T_truth_filter, wall->to);
    list.push_back({short_number(from.x()), short_number(from.y()), short_number(to.x()),
                    short_number(to.y()), landmark.id, landmark.times_seen});
  }
  return list;
}

/// What only a run in the plane has.
void add_planar_parts(Json& data, const ReportInput& in, const TPose2D& T_truth_filter) {
  if (Json walls = wall_list(in.map, T_truth_filter); !walls.empty())
    data["walls"] = std::move(walls);
  if (in.smoothed != nullptr)
    data["smoothed"] = polyline(in.smoothed->poses.size(), [&](std::size_t i) {
      return transform_point(T_truth_filter, in.smoothed->poses[i].head<2>());
    });
}

/// Where the run was when something happened.
void add_events(Json& data, const ReportInput& in, const auto& view) {
  const auto before = [](std::int64_t step, const EstimatedPose& p) { return step < p.step; };
  for (const RunEvent& event : in.summary.health.events) {
    const auto after =
        std::upper_bound(in.path.poses.begin(), in.path.poses.end(), event.step, before);
    if (after == in.path.poses.begin()) continue;
    const auto row = static_cast<std::size_t>(after - in.path.poses.begin()) - 1;
    const Eigen::Vector2d place = view.pose(row).mean;
    data["events"].push_back({short_number(place.x()), short_number(place.y()), event.what});
  }
}

Json view_data(const ReportInput& in, const auto& view, bool with_truth) {
  const std::size_t poses = view.path.size();
  Json data = {{"ellipse_scale", std::sqrt(chi_square_quantile(0.95, 2))}};
  data["path"] = polyline(poses, [&](std::size_t i) { return view.pose(i).mean; });
  data["truth"] = polyline(with_truth ? view.truth.poses.size() : 0,
                           [&](std::size_t i) { return view.true_pose(i); });
  data["truth_is_sparse"] = !view.truth.has_heading;
  data["pose_ellipses"] = Json::array();
  for_each_strided(poses, kPoseEllipses,
                   [&](std::size_t i) { data["pose_ellipses"].push_back(ellipse(view.pose(i))); });
  data["landmarks"] = landmark_list(in.map, view);
  data["true_landmarks"] =
      with_truth ? true_landmark_list(in.truth.landmarks, view) : Json::array();
  add_events(data, in, view);
  return data;
}

/// A thousandth of the larger extent on the ground is not worth a view from the side.
bool height_varies(const SpatialView& view, const LandmarkMap& map) {
  Eigen::AlignedBox3d box;
  for (const SpatialEstimate& step : view.path) box.extend(view.T * step.pose.position);
  for (const LandmarkEstimate& landmark : map)
    if (landmark.type == "point" && landmark.mean.size() == 3)
      box.extend(view.T * Eigen::Vector3d(landmark.mean));
  if (box.isEmpty()) return false;
  const Eigen::Vector3d extent = box.sizes();
  return extent.z() > std::max(1e-9, 1e-3 * std::max(extent.x(), extent.y()));
}

}  // namespace

Json short_number(double value) {
  if (!std::isfinite(value)) return nullptr;
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return std::strtod(text, nullptr);
}

void add_map_data(Json& data, const ReportInput& in) {
  const TruthComparison known = in.summary.truth.value_or(TruthComparison());
  if (in.path.spatial.empty() || known.placement) {
    const PlanarView view{path_of_point(in.path.poses, in.truth.path.point_on_robot), in.truth.path,
                          known.placement.value_or(TPose2D(0, 0, 0))};
    data["map"] = view_data(in, view, known.placement.has_value());
    add_planar_parts(data["map"], in, view.T);
    return;
  }
  const Trajectory truth = comparable_truth(in.path, in.truth.path);
  SpatialView view{path_of_point(in.path.spatial, truth.point_on_robot), truth,
                   known.spatial_placement.value_or(Eigen::Isometry3d::Identity()), 1};
  data["map"] = view_data(in, view, known.spatial_placement.has_value());
  if (!height_varies(view, in.map)) return;
  view.vertical = 2;
  data["side"] = view_data(in, view, known.spatial_placement.has_value());
}

}  // namespace libslam
