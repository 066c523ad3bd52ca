#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <mrpt/math/CQuaternion.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <libslam/io/exporters/simple_map.hpp>
#include <libslam/result/atomic_file.hpp>
#include <libslam/result/spatial_alignment.hpp>

namespace libslam {
namespace {

/// Derivative of (yaw, pitch, roll) by the rotation vector in the world. Near a pitch of +-90
/// degrees, where yaw and roll cannot be told apart, the turn stays finite.
Eigen::Matrix3d angles_by_rotation(double yaw, double pitch) {
  const double cy = std::cos(yaw), sy = std::sin(yaw), sp = std::sin(pitch);
  const double cp = std::copysign(std::max(std::abs(std::cos(pitch)), 1e-6), std::cos(pitch));
  Eigen::Matrix3d J;
  J << cy * sp / cp, sy * sp / cp, 1.0, -sy, cy, 0.0, cy / cp, sy / cp, 0.0;
  return J;
}

mrpt::poses::CPose3DPDF::Ptr gaussian_of(const SpatialEstimate& estimate) {
  const auto& p = estimate.pose.position;
  const auto& q = estimate.pose.rotation;
  const mrpt::poses::CPose3D mean(mrpt::math::CQuaternionDouble(q.w(), q.x(), q.y(), q.z()), p.x(),
                                  p.y(), p.z());
  Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Identity();
  J.bottomRightCorner<3, 3>() = angles_by_rotation(mean.yaw(), mean.pitch());
  const Eigen::Matrix<double, 6, 6> cov = J * estimate.cov * J.transpose();
  mrpt::math::CMatrixDouble66 matrix;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) matrix(i, j) = cov(i, j);
  return mrpt::poses::CPose3DPDFGaussian::Create(mean, matrix);
}

}  // namespace

SimpleMapWriter::SimpleMapWriter(Spacing spacing, std::size_t max_pairs)
    : spacing_(spacing), max_pairs_(max_pairs) {
  if (max_pairs < 2) throw std::invalid_argument("a simple map needs room for two pairs");
  if (!(spacing.distance_m >= 0.0 && spacing.turn_rad >= 0.0))
    throw std::invalid_argument("the spacing of a simple map must not be negative");
}

bool SimpleMapWriter::is_far_enough(const SpatialPose& place) const {
  if (pairs_.empty()) return true;
  const SpatialPose& last = pairs_.back().place;
  return (place.position - last.position).norm() >= spacing_.distance_m ||
         place.rotation.angularDistance(last.rotation) >= spacing_.turn_rad;
}

void SimpleMapWriter::add(const Eigen::Vector3d& pose, const Eigen::Matrix3d& cov,
                          const mrpt::obs::CSensoryFrame::Ptr& frame, double time) {
  if (!frame) return;
  const SpatialPose place = lift_to_space({&pose, 1}).front();
  if (!is_far_enough(place)) return;
  if (pairs_.size() == max_pairs_) drop_every_second();
  mrpt::math::CMatrixDouble33 planar;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) planar(i, j) = cov(i, j);
  const mrpt::poses::CPosePDFGaussian gaussian(mrpt::poses::CPose2D(pose.x(), pose.y(), pose.z()),
                                               planar);
  pairs_.push_back({place,
                    mrpt::poses::CPose3DPDF::Ptr(mrpt::poses::CPose3DPDF::createFrom2D(gaussian)),
                    frame, time});
}

void SimpleMapWriter::add(const SpatialEstimate& estimate,
                          const mrpt::obs::CSensoryFrame::Ptr& frame, double time) {
  if (!frame || !is_far_enough(estimate.pose)) return;
  if (pairs_.size() == max_pairs_) drop_every_second();
  pairs_.push_back({estimate.pose, gaussian_of(estimate), frame, time});
}

void SimpleMapWriter::correct(const Trajectory& path) {
  constexpr double kSameTime = 1e-6;
  for (Pair& pair : pairs_) {
    const auto at = std::lower_bound(path.times.begin(), path.times.end(), pair.time - kSameTime);
    if (at == path.times.end() || *at > pair.time + kSameTime) continue;
    if (at + 1 != path.times.end() && *(at + 1) <= pair.time + kSameTime) continue;  // which one?
    const Eigen::Vector3d& pose = path.poses[static_cast<std::size_t>(at - path.times.begin())];
    mrpt::math::CMatrixDouble66 cov;
    mrpt::poses::CPose3D before;
    pair.pose->getCovarianceAndMean(cov, before);
    pair.place = lift_to_space({&pose, 1}).front();
    pair.pose = mrpt::poses::CPose3DPDFGaussian::Create(
        mrpt::poses::CPose3D(pose.x(), pose.y(), before.z(), pose.z(), 0.0, 0.0), cov);
  }
}

void SimpleMapWriter::drop_every_second() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs_.size(); i += 2) pairs_[kept++] = std::move(pairs_[i]);
  pairs_.resize(kept);
  spacing_.distance_m *= 2.0;
  spacing_.turn_rad *= 2.0;
}

mrpt::maps::CSimpleMap SimpleMapWriter::map() const {
  mrpt::maps::CSimpleMap map;
  for (const Pair& pair : pairs_) map.insert(pair.pose, pair.frame);
  return map;
}

void SimpleMapWriter::write(const std::filesystem::path& file) const {
  replace_file(file, [&](const std::filesystem::path& temporary) {
    return map().saveToFile(temporary.string());
  });
}

}  // namespace libslam
