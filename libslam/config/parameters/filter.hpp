#pragma once
// The estimator.

#include <string>

#include <libslam/config/description.hpp>

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
  double initial_sigma_xy = 0.0;
  double initial_sigma_heading_deg = 0.0;
  BuildingPriorParameters building_prior;

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
    v.value("initial_sigma_xy", initial_sigma_xy,
            {"m", "Standard deviation of the start position.", 0});
    v.value("initial_sigma_heading_deg", initial_sigma_heading_deg,
            {"deg", "Standard deviation of the start heading.", 0});
    v.section("building_prior", building_prior);
  }
};

}  // namespace libslam
