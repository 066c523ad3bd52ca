#pragma once
// The estimator.

#include <string>

#include <libslam/config/description.hpp>
#include <libslam/config/parameters/loop_closure.hpp>

namespace libslam {

/// Section `filter.building_prior`.
struct BuildingPriorParameters {
  bool enabled = false;
  double sigma_deg = 3.0;
  int min_sightings = 4;
  double min_length = 1.2;
  double probability = 0.99;

  void describe(auto& v) {
    v.value("enabled", enabled,
            {"",
             "Estimate the main direction of the walls, and tell every line once that it is "
             "probably parallel or at right angles to it."});
    v.value("sigma_deg", sigma_deg,
            {"deg", "Standard deviation of a wall from the main directions.", 1e-3, 45});
    v.value("min_sightings", min_sightings, {"1", "Sightings of a line before it is told.", 1});
    v.value("min_length", min_length, {"m", "Length of a line before it is told.", 0});
    v.value("probability", probability,
            {"1", "A line beyond this chi-square probability is oblique and left alone.", 1e-6, 1});
  }
};

/// Section `filter`.
struct FilterParameters {
  std::string error_frame = "right_invariant";
  std::string linearization = "estimate";
  int update_linearizations = 1;
  double initial_sigma_xy = 0.0;
  double initial_sigma_heading_deg = 0.0;
  BuildingPriorParameters building_prior;
  LoopClosureParameters loop_closure;
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
    v.section("building_prior", building_prior);
    v.section("loop_closure", loop_closure);
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
