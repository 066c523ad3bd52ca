#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/poses/CPosePDFGaussian.h>

#include <libslam/modules/start_pose.hpp>

namespace libslam {

SpatialEstimate spatial_estimate(const StepRecord& record) {
  if (record.spatial) return *record.spatial;
  SpatialEstimate estimate;
  estimate.pose.position.head<2>() = record.pose.head<2>();
  estimate.pose.rotation = Eigen::AngleAxisd(record.pose[2], Eigen::Vector3d::UnitZ());
  constexpr int kPlanar[] = {0, 1, 5};  // of position and rotation vector
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) estimate.cov(kPlanar[r], kPlanar[c]) = record.cov(r, c);
  return estimate;
}

FilterStart start_at(const StepRecord& record, bool spatial) {
  FilterStart start;
  if (!spatial) {
    start.pose = record.pose;
    start.cov = record.cov;
    return start;
  }
  const SpatialEstimate estimate = spatial_estimate(record);
  start.pose.resize(7);
  start.pose << estimate.pose.position, estimate.pose.rotation.coeffs();
  start.cov = estimate.cov;
  return start;
}

FilterStart start_at(const mrpt::poses::CPosePDF& pose, bool spatial) {
  mrpt::poses::CPosePDFGaussian gaussian;
  gaussian.copyFrom(pose);
  StepRecord record;
  record.pose = {gaussian.mean.x(), gaussian.mean.y(), gaussian.mean.phi()};
  record.cov = gaussian.cov.asEigen();
  return start_at(record, spatial);
}

}  // namespace libslam
