#pragma once
// Configuration -> objects: the one place that knows concrete models.

#include <memory>

#include <libslam/config/parameters.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/frontend/frontend.hpp>

namespace libslam {

/// The motion model of a filter or of a simulated vehicle. Throws std::invalid_argument on a value
/// that validation would have refused.
std::unique_ptr<MotionModel> make_motion_model(const MotionParameters& motion,
                                               const CalibrationParameters& calibration,
                                               const InputParameters& input);

/// The parts of the filter that `parameters` describe. `truth` is what `filter.linearization:
/// at_truth` asks for, and must outlive the filter. Reads the map that `map.file` names. Throws
/// InputError if it cannot, std::invalid_argument on a value that validation
/// (config/validation.hpp) would have refused.
EkfSlamParts make_filter_parts(const Parameters& parameters, const TrueState* truth = nullptr);

std::unique_ptr<Frontend> make_frontend(const Parameters& parameters);

}  // namespace libslam
