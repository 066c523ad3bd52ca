#pragma once
// Relocalization: the pose of a lost robot from the constellation of what it sees.
//
//   seen points q_i (robot frame), map points m_k (world frame), planar;  T = T_world_robot
//   e_ik = m_k - T q_i,   S_ik = cov(m_k) + R cov(q_i) R^T
//
// Candidates: two seen points and two map points that are equally far apart fix a pose; the others
// vote. The best poses are fitted by least squares and weighed by their posterior odds against
// "somewhere else, and all that is seen is not in the map":
//
//   log odds = log(sqrt((2 pi)^3 |C|) / (2 pi A)) + sum_paired log(p_D N(e; 0, S) / lambda)
//              + n_missed log(1 - p_D)
//
// C  covariance of the fitted pose;  A  area of the map with a margin: the pose is uniform there
// lambda  density of objects that are not in the map [1/m^2];  p_D  probability to see a landmark
// n_missed  landmarks that should be in view and are paired with nothing
//
// The first term is the price of choosing the pose out of all places: in a wide or dense map few
// pairs prove little, and in a sparse one four may do. A pose counts as found only if it holds
// against that and against all other poses together.
//
// Covariance: C = (sum J^T S^-1 J)^-1, errors of different map points taken as independent. Where
// the filter has the cross-covariances of its map (it is SLAM), do not put C into it: start the
// pose block at T with 100 C, independent of the map, and correct it with the pairs of the current
// frame in the ordinary update. That gives the joint covariance of pose and map exactly, and the
// pairs, which are in C already, count 1 % twice.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/association/associator.hpp>
#include <libslam/association/constellation_index.hpp>

namespace libslam {

/// What a sensor could see from somewhere; the union of several is what was seen recently.
struct SensorView {
  Eigen::Vector3d T_robot_sensor = Eigen::Vector3d::Zero();  ///< in today's robot frame
  double max_range = 0.0;                                    ///< [m]
  double field_of_view = 0.0;                                ///< [rad], about the x axis
};

struct ConstellationOptions {
  double detection_probability = 0.9;
  /// Density of objects that are not in the map, as a part of the density of the map.
  double unmapped_density_ratio = 1.0;
  std::size_t least_pairs = 4;
  double least_paired_fraction = 0.4;  ///< of what is seen
  double pair_probability = 0.999;     ///< chi-square gate of a pair
  double fit_probability = 0.999;      ///< chi-square gate of the fit of all pairs
  double least_log_odds = 9.2;         ///< against all else together; 9.2: 1 in 10 000
  std::size_t budget = 12'000;         ///< poses that are voted on, most
};

enum class ConstellationVerdict {
  kFound,
  kTooFew,     ///< too few points are seen, or no pose explains enough of them
  kMisfit,     ///< the best pose does not fit
  kAmbiguous,  ///< another pose, or none, is nearly as likely
};

struct ConstellationMatch {
  ConstellationVerdict verdict = ConstellationVerdict::kTooFew;
  Eigen::Vector3d T_world_robot = Eigen::Vector3d::Zero();  ///< x [m], y [m], phi [rad]
  Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();            ///< C, in the world frame
  std::vector<Pairing> pairs;  ///< positions in what is seen and in the map
  double mahalanobis2 = 0.0;   ///< of the fit; 2 |pairs| - 3 degrees of freedom
  std::size_t missed = 0;      ///< landmarks in view that are paired with nothing
  double log_odds = 0.0;       ///< against all else together
};

/// Finds the robot in `map`. The same input gives the same result; the time is bounded by the
/// budget of `options`. Points seen in several frames, moved into today's robot frame by odometry,
/// can be given together (see RecentSightings), with one view per frame.
ConstellationMatch match_constellation(const ConstellationIndex& map,
                                       std::span<const PlanarPoint> seen,
                                       std::span<const SensorView> views,
                                       const ConstellationOptions& options = {});

}  // namespace libslam
