#pragma once
// The measurements of one observation, stacked, before they correct anything.

#include <Eigen/Core>

namespace libslam {

struct JointInnovation {
  Eigen::VectorXd nu;        ///< z - h(x), m rows
  Eigen::MatrixXd cov;       ///< S = H P H^T + R, m x m
  Eigen::MatrixXd wrt_pose;  ///< columns of H of the pose, m x d
  double trace_noise = 0.0;  ///< tr R
};

}  // namespace libslam
