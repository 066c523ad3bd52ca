#pragma once
// Configuration -> objects: the one place that knows concrete models.

#include <memory>

#include <libslam/config/parameters.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/frontend/frontend.hpp>

namespace libslam {

/// The parts of the filter that `parameters` describe. Throws std::invalid_argument on a value that
/// validation (config/validation.hpp) would have refused.
EkfSlamParts make_filter_parts(const Parameters& parameters);

std::unique_ptr<Frontend> make_frontend(const Parameters& parameters);

}  // namespace libslam
