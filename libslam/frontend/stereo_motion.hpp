#pragma once
// How a stereo camera moved between two pairs, from points that stand still.

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <libslam/frontend/stereo_match.hpp>

namespace libslam {

/// One point before and after the motion.
struct SightingPair {
  Eigen::Vector3d p_before = Eigen::Vector3d::Zero();       ///< camera frame before [m]
  Eigen::Matrix3d cov_before = Eigen::Matrix3d::Zero();     ///< of `p_before`
  Eigen::Vector3d z_after = Eigen::Vector3d::Zero();        ///< (u, v, d) [px]
  Eigen::Matrix3d cov_after = Eigen::Matrix3d::Identity();  ///< of `z_after`
};

struct StereoMotion {
  Eigen::Isometry3d T_after_before = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> cov = Eigen::Matrix<double, 6, 6>::Zero();  ///< translation, rotation
  std::vector<bool> agrees;  ///< per pair: within the gate of the motion
  int support = 0;           ///< pairs that agree
};

/// Squared Mahalanobis distance of a pair from a motion; infinite behind the camera.
double disagreement(const StereoCamera& camera, const Eigen::Isometry3d& T_after_before,
                    const SightingPair& pair);

/// Position and covariance of a stereo point.
void locate(const StereoCamera& camera, const StereoMatch& point, Eigen::Vector3d& p,
            Eigen::Matrix3d& cov);

/// Consensus over triples (absolute orientation; Fischler & Bolles 1981), then Gauss-Newton on
///     sum_i e_i^T (R_i + J_i P_i J_i^T)^-1 e_i,   e_i = z_i - h(T p_i),
/// over the pairs that agree, repeated with the pairs that agree then. The triples come from a
/// generator with a fixed seed: the same pairs give the same motion. `first_guess` is a candidate
/// too. `gate`: chi-square value of 3 degrees of freedom. Nothing where fewer than `least_support`
/// pairs agree.
std::optional<StereoMotion> estimate_stereo_motion(const StereoCamera& camera,
                                                   std::span<const SightingPair> pairs,
                                                   const Eigen::Isometry3d& first_guess,
                                                   double gate, int least_support = 8);

}  // namespace libslam
