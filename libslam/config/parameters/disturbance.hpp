#pragma once
// What to do when something moves the robot that its odometry does not know of.

#include <string>

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `policies.disturbance`.
struct DisturbanceParameters {
  std::string response = "none";
  int window = 5;
  double trigger_probability = 0.99999;
  double release_probability = 0.95;
  int hold_updates = 5;
  double sigma_xy = 3.0;
  double sigma_heading_deg = 20.0;
  double max_factor = 100.0;
  double near_landmark = 10.0;
  bool relocalize = true;
  int lost_after = 3;
  double slip_probability = 0.001;

  void describe(auto& v) {
    v.value("response", response,
            {"",
             "Answer to slip, a push or a kidnap: maximum_likelihood and additive add covariance "
             "to the pose, as much as fits the observation or all of it; whole_state multiplies "
             "the covariance of pose and map, for comparison.",
             0,
             0,
             {"none", "maximum_likelihood", "additive", "whole_state"}});
    v.value("window", window,
            {"1",
             "The innovations of an update are tested alone and together with those of the "
             "updates before it, so many in all.",
             1, 1000});
    v.value("trigger_probability", trigger_probability,
            {"1",
             "A disturbance begins where the sum of the squared innovations is beyond this "
             "chi-square probability.",
             0.5, 1});
    v.value("release_probability", release_probability,
            {"1", "An update is quiet where they are below this chi-square probability.", 0.1, 1});
    v.value("hold_updates", hold_updates,
            {"1",
             "A disturbance ends after so many quiet updates; until then calibration and noise do "
             "not learn and no landmark is added.",
             1, 10000});
    v.value("sigma_xy", sigma_xy,
            {"m", "Standard deviation of the displacement that is added to the pose.", 1e-6});
    v.value("sigma_heading_deg", sigma_heading_deg, {"deg", "The same of its turn.", 1e-6, 360});
    v.value("max_factor", max_factor, {"1", "Largest factor on the covariance (whole_state).", 1});
    v.value("near_landmark", near_landmark,
            {"m",
             "Observations without identity that fit no landmark although one is this near are a "
             "sign of a disturbance when they are at least half of a frame.",
             0});
    v.value("relocalize", relocalize,
            {"",
             "Search the whole map for what is seen when the pose is lost. A search in the plane: "
             "robots in space and landmarks with three coordinates go without it."});
    v.value(
        "lost_after", lost_after,
        {"1", "The pose is lost after so many updates in a row that nothing explains.", 1, 10000});
    v.value("slip_probability", slip_probability,
            {"1",
             "Probability, before anything was seen, that the wheels slipped in one of the last 8 "
             "intervals between updates: what the updates since say of it is weighed against it, "
             "and a slip corrects pose, map and calibration in hindsight; 0: none is looked for.",
             0, 0.5});
  }
};

}  // namespace libslam
