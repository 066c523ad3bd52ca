#pragma once
// Observations that ask for an impossible motion.

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `policies.implied_input`.
struct ImpliedInputParameters {
  bool enabled = false;
  double probability = 0.99997;

  void describe(auto& v) {
    v.value("enabled", enabled,
            {"",
             "Test the motion that an observation implies against the noise of the odometry since "
             "the last update; reject the observation where they disagree and start all its "
             "landmarks anew: a tracker that froze or jumped as a whole."});
    v.value(
        "probability", probability,
        {"1", "Chi-square probability of the implied motion beyond which it is impossible.", 0, 1});
  }
};

}  // namespace libslam
