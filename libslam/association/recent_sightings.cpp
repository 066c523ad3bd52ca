#include <Eigen/LU>

#include <libslam/association/pose_fit.hpp>
#include <libslam/association/recent_sightings.hpp>
#include <libslam/state/block.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {

namespace {

constexpr double kSameObject = 0.999;

}  // namespace

void RecentSightings::move(const Eigen::Vector3d& T_old_new, const Eigen::Matrix3d& cov) {
  const Eigen::Matrix2d R_new_old = rotation_of(T_old_new).transpose();
  for (PlanarPoint& point : points_) {
    point.position = R_new_old * (point.position - T_old_new.head<2>());
    Eigen::Matrix<double, 2, 3> jacobian;  // of the new position with respect to T_old_new
    jacobian << -R_new_old, Eigen::Vector2d(point.position.y(), -point.position.x());
    point.cov =
        R_new_old * point.cov * R_new_old.transpose() + jacobian * cov * jacobian.transpose();
  }
  for (SensorView& view : views_) {
    view.T_robot_sensor.head<2>() =
        R_new_old * (view.T_robot_sensor.head<2>() - T_old_new.head<2>());
    view.T_robot_sensor[2] = wrap_angle(view.T_robot_sensor[2] - T_old_new[2]);
  }
}

void RecentSightings::add(std::span<const PlanarPoint> seen, const SensorView& view) {
  static const double kGate = chi_square_quantile(kSameObject, 2);
  ++now_;
  const std::size_t before = points_.size();
  std::vector<std::size_t> partner(seen.size()), partners(seen.size(), 0), claims(before, 0);
  for (std::size_t i = 0; i < seen.size(); ++i)
    for (std::size_t k = 0; k < before; ++k) {
      const Eigen::Vector2d e = seen[i].position - points_[k].position;
      if (e.dot((seen[i].cov + points_[k].cov).inverse() * e) > kGate) continue;
      partner[i] = k;
      ++partners[i];
      ++claims[k];
      last_seen_[k] = now_;
    }
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (partners[i] == 0) {
      points_.push_back(seen[i]);
      last_seen_.push_back(now_);
    } else if (partners[i] == 1 && claims[partner[i]] == 1) {
      fuse(points_[partner[i]], seen[i]);
    }
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (last_seen_[k] + frames_ <= now_) continue;
    points_[kept] = points_[k];
    last_seen_[kept++] = last_seen_[k];
  }
  points_.resize(kept);
  last_seen_.resize(kept);
  views_.push_back(view);
  if (views_.size() > frames_) views_.erase(views_.begin());
}

void RecentSightings::fuse(PlanarPoint& old, const PlanarPoint& again) const {
  const Eigen::Matrix2d gain = old.cov * (old.cov + again.cov).inverse();
  old.position += gain * (again.position - old.position);
  old.cov -= gain * old.cov;
  old.cov = (0.5 * (old.cov + old.cov.transpose())).eval();
}

void RecentSightings::clear() {
  points_.clear();
  last_seen_.clear();
  views_.clear();
}

}  // namespace libslam
