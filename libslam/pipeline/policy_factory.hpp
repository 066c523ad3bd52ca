#pragma once
// Configuration -> policies of a filter.

#include <memory>
#include <optional>

#include <libslam/config/parameters.hpp>
#include <libslam/filter/ekf_slam.hpp>

namespace libslam {

// Each is null or absent where the configuration switches it off, and throws std::invalid_argument
// on a value that validation would have refused.

std::unique_ptr<NoisePolicy> make_noise_policy(const Parameters& p);
std::unique_ptr<ProcessScale> make_process_policy(const Parameters& p,
                                                  const MeasurementModel& model);
/// Relocalization is planar: `landmark` must be, too, or the robot is not searched for.
std::optional<DisturbanceResponse> make_disturbance_response(const DisturbanceParameters& p,
                                                             const BlockSpec& pose,
                                                             const BlockSpec& landmark);

}  // namespace libslam
