#include <cmath>

#include <libslam/measurement/relative_pose.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

void linearize_relative_pose(const GaussianState& state, BlockId a, BlockId b,
                             const Eigen::Vector3d& T_a_b, const Eigen::Matrix3d& cov,
                             LinearizedMeasurement& out) {
  const Eigen::Vector3d from = state.estimate(a);
  const Eigen::Vector3d h = relative_pose(from, state.estimate(b));
  const double c = std::cos(from.z()), s = std::sin(from.z());
  out.innovation = T_a_b - h;
  out.innovation[2] = wrap_angle(out.innovation[2]);
  out.cov = cov;
  out.wrt.clear();
  out.wrt.add(a, 3, 3) << -c, -s, h.y(), s, -c, -h.x(), 0.0, 0.0, -1.0;
  out.wrt.add(b, 3, 3) << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
}

}  // namespace libslam
