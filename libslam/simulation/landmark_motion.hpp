#pragma once
// Where landmarks stand at a time.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/ground_truth.hpp>
#include <libslam/simulation/fault_parameters.hpp>

namespace libslam {

/// Landmarks stand still, but for those that `faults.moving_landmarks` sends to and fro at constant
/// speed on a line that begins at their place, each in a direction of its own.
class LandmarkMotion {
 public:
  LandmarkMotion(const MovingLandmarkParameters& parameters,
                 const std::vector<TrueLandmark>& landmarks, std::uint64_t seed);

  /// Overwrites `p_world` with the positions `elapsed` [s] after the start; z is 0 where a landmark
  /// has no height.
  void place(double elapsed, std::vector<Eigen::Vector3d>& p_world) const;
  bool any() const { return any_; }

 private:
  MovingLandmarkParameters parameters_;
  std::vector<Eigen::Vector3d> start_;
  std::vector<Eigen::Vector3d> direction_;  ///< unit vectors, zero for those that stand
  bool any_ = false;
};

}  // namespace libslam
