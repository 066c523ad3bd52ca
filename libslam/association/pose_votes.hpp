#pragma once
// Poses that two seen points and two map points of equal distance propose and the others support.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/association/constellation_index.hpp>

namespace libslam {

struct PoseVote {
  Eigen::Vector3d T_world_robot;  ///< x [m], y [m], phi [rad]
  Eigen::Matrix3d cov;            ///< of the fit of the two pairs that propose it
  std::size_t votes = 0;          ///< seen points near some point of the map, the two included
};

struct PoseVoteOptions {
  std::size_t least_votes = 4;
  double least_fraction = 0.4;  ///< of those who vote
  std::size_t budget = 12'000;  ///< poses that are tried, most
};

/// Only the points that are known best vote: the others fit nearly everywhere.
inline constexpr std::size_t kMaxVoters = 16;
inline constexpr std::size_t kMaxVotes = 32;

/// The poses with most votes, at most `kMaxVotes`; poses that agree are one. Pairs of seen points
/// that leave the fewest and the sharpest poses come first; each is tried against all its partners
/// or not at all.
std::vector<PoseVote> vote_on_poses(const ConstellationIndex& map,
                                    std::span<const PlanarPoint> seen,
                                    const PoseVoteOptions& options);

}  // namespace libslam
