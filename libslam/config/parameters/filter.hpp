#pragma once
// The estimator.

#include <string>

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `filter`.
struct FilterParameters {
  std::string error_frame = "right_invariant";
  std::string linearization = "estimate";
  int update_linearizations = 1;
  double initial_sigma_xy = 0.0;
  double initial_sigma_heading_deg = 0.0;
  double delayed_pose_distance = 0.0;
  double delayed_pose_turn_deg = 30.0;

  void describe(auto& v) {
    v.value("error_frame", error_frame,
            {"", "Error that the covariance describes.", 0, 0, {"standard", "right_invariant"}});
    v.value(
        "linearization", linearization,
        {"",
         "Where derivatives are taken: at the estimate, at the first estimates of landmarks and "
         "the predicted pose, or at the truth (simulations only).",
         0,
         0,
         {"estimate", "first_estimate", "at_truth"}});
    v.value("update_linearizations", update_linearizations,
            {"1",
             "Most linearizations of one correction; more than 1: the iterated EKF, for what is "
             "hardly known beforehand, such as the velocity of constant_twist.",
             1, 20});
    v.value("initial_sigma_xy", initial_sigma_xy,
            {"m", "Standard deviation of the start position.", 0});
    v.value("initial_sigma_heading_deg", initial_sigma_heading_deg,
            {"deg", "Standard deviation of the start heading.", 0});
    v.value("delayed_pose_distance", delayed_pose_distance,
            {"m",
             "A pose is kept in the state this far after the one before, so that later knowledge "
             "corrects it: trajectory_smoothed.tum. 0: none. Each costs what a landmark costs.",
             0});
    v.value("delayed_pose_turn_deg", delayed_pose_turn_deg,
            {"deg", "A pose is kept after this turn, too.", 1, 360});
  }
};

}  // namespace libslam
