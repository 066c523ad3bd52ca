#pragma once
// A path against relations between pairs of its poses: what loops and drift leave, without a
// common frame.

#include <optional>
#include <span>

#include <libslam/data/ground_truth.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {

/// With d = est(t1)^-1 est(t2) and e = T_from_to^-1 d: mean and standard deviation (over all
/// matched relations, divided by their number) of the length of e [m] and of its angle [deg],
/// translation and rotation apart. Every relation weighs the same.
///
/// Kuemmerle, Steder, Dornhege et al., "On measuring the accuracy of SLAM algorithms", Autonomous
/// Robots 27, 2009, eqs. (5) and (6).
struct RelationErrors {
  double trans_mean_m = 0.0, trans_std_m = 0.0;
  double rot_mean_deg = 0.0, rot_std_deg = 0.0;
  int matched = 0;
  int unmatched = 0;  ///< relations with a time at which the path has no pose
};

/// Poses are matched to the nearest time within a millisecond; of several poses of one time the
/// last counts. `path`: times never decrease. Nothing where no relation matches.
std::optional<RelationErrors> compare_relations(std::span<const EstimatedPose> path,
                                                std::span<const PoseRelation> relations);

/// The same of a path with times.
std::optional<RelationErrors> compare_relations(const Trajectory& path,
                                                std::span<const PoseRelation> relations);

}  // namespace libslam
