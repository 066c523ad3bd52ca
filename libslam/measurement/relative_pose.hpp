#pragma once
// How one planar pose of the state stands to another.
//
//   z = T_a^-1 T_b = [ R_a^T (p_b - p_a) ;  wrap(phi_b - phi_a) ] + v

#include <Eigen/Core>

#include <libslam/state/gaussian_state.hpp>
#include <libslam/state/linearization.hpp>

namespace libslam {

/// `T_a_b`: x [m], y [m], phi [rad] as measured, with the covariance of these. Both blocks are
/// planar poses. The innovation of phi is wrapped to (-pi, pi].
void linearize_relative_pose(const GaussianState& state, BlockId a, BlockId b,
                             const Eigen::Vector3d& T_a_b, const Eigen::Matrix3d& cov,
                             LinearizedMeasurement& out);

}  // namespace libslam
