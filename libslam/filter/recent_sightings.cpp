#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Dense>

#include <libslam/filter/recent_sightings.hpp>
#include <libslam/state/block.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {

namespace {

/// Two sightings farther apart are two objects.
constexpr double kSameObject = 0.999;

double mahalanobis2(const PlanarPoint& a, const PlanarPoint& b) {
  const Eigen::Vector2d e = a.position - b.position;
  const Eigen::Matrix2d s = a.cov + b.cov;
  return e.dot(s.inverse() * e);
}

PlanarPoint fused(const PlanarPoint& a, const PlanarPoint& b) {
  const Eigen::Matrix2d gain = a.cov * (a.cov + b.cov).inverse();
  const Eigen::Matrix2d cov = a.cov - gain * a.cov;
  return {a.position + gain * (b.position - a.position), 0.5 * (cov + cov.transpose())};
}

}  // namespace

RecentSightings::RecentSightings(int memory) : memory_(memory) {
  if (memory < 1) throw std::invalid_argument("sightings need a memory of one observation");
}

void RecentSightings::clear() {
  sightings_.clear();
  views_.clear();
  latest_.clear();
}

void RecentSightings::move(const Eigen::Vector3d& increment, const Eigen::Matrix3d& cov) {
  const Eigen::Matrix2d to_new = Eigen::Rotation2Dd(-increment[2]).toRotationMatrix();
  for (Sighting& sighting : sightings_) {
    auto& [position, spread] = sighting.seen.point;
    position = to_new * (position - increment.head<2>());
    Eigen::Matrix<double, 2, 3> wrt_increment;
    wrt_increment << -to_new, Eigen::Vector2d(position.y(), -position.x());
    spread = to_new * spread * to_new.transpose() + wrt_increment * cov * wrt_increment.transpose();
  }
  for (auto& [view, age] : views_) {
    view.T_robot_sensor.head<2>() = to_new * (view.T_robot_sensor.head<2>() - increment.head<2>());
    view.T_robot_sensor[2] = wrap_angle(view.T_robot_sensor[2] - increment[2]);
  }
}

void RecentSightings::add(std::span<const SightedPoint> observation, const SensorView& view) {
  for (Sighting& sighting : sightings_) ++sighting.age;
  for (View& seen_from : views_) ++seen_from.age;
  const auto forgotten = [this](const auto& item) { return item.age >= memory_; };
  std::erase_if(sightings_, forgotten);
  std::erase_if(views_, forgotten);
  views_.push_back({view, 0});
  latest_.clear();
  for (const SightedPoint& point : observation) {
    const std::size_t known = partner(point);
    if (known == sightings_.size())
      sightings_.push_back({point, 0});
    else
      sightings_[known] = {{point.id, fused(sightings_[known].seen.point, point.point)}, 0};
    latest_.push_back(known);
  }
}

bool RecentSightings::is_latest(std::size_t sighting) const {
  return std::ranges::find(latest_, sighting) != latest_.end();
}

std::size_t RecentSightings::partner(const SightedPoint& point) const {
  static const double kGate = chi_square_quantile(kSameObject, 2);
  std::size_t best = sightings_.size();
  double least = kGate;
  for (std::size_t i = 0; i < sightings_.size(); ++i) {
    const SightedPoint& other = sightings_[i].seen;
    if (is_latest(i) || other.id != point.id) continue;
    if (point.id != kNoIdentity) return i;
    if (const double d2 = mahalanobis2(other.point, point.point); d2 <= least) {
      least = d2;
      best = i;
    }
  }
  return best;
}

std::vector<PlanarPoint> RecentSightings::points() const {
  std::vector<PlanarPoint> points;
  for (const Sighting& sighting : sightings_) points.push_back(sighting.seen.point);
  return points;
}

std::vector<SensorView> RecentSightings::views() const {
  std::vector<SensorView> views;
  for (const View& view : views_) views.push_back(view.view);
  return views;
}

}  // namespace libslam
