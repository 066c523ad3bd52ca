#pragma once
// Noise that was adapted far away from what was configured.

#include <span>
#include <string>
#include <vector>

#include <libslam/data/step_record.hpp>

namespace libslam {

/// One line for each noise whose sigma ended below a third of the configured one or above three
/// times of it. Adaptation then covers up something: a wrong configuration, a defect, or errors
/// that are not white. Large ones are errors that the model does not have; small ones, errors that
/// all measurements share, which no residual shows and which the pose takes over.
std::vector<std::string> warnings_about(std::span<const AdaptedNoise> noise);

}  // namespace libslam
