#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include <libslam/motion/calibration_layout.hpp>

namespace libslam {

namespace {

struct Entry {
  const char* name;
  CalibrationParameter CalibrationParameters::*parameter;
};

// In the order of CalibrationIndex.
constexpr std::array<Entry, kCalibrationCount> kEntries{{
    {"scale_left", &CalibrationParameters::scale_left},
    {"scale_right", &CalibrationParameters::scale_right},
    {"track_width", &CalibrationParameters::track_width},
    {"scale_speed", &CalibrationParameters::scale_speed},
    {"scale_steering", &CalibrationParameters::scale_steering},
    {"bias_steering", &CalibrationParameters::bias_steering},
    {"scale_turn", &CalibrationParameters::scale_turn},
    {"bias_turn", &CalibrationParameters::bias_turn},
}};

}  // namespace

CalibrationLayout::CalibrationLayout(const CalibrationParameters& parameters,
                                     std::initializer_list<CalibrationIndex> supported,
                                     std::string_view model) {
  for (std::size_t i = 0; i < kEntries.size(); ++i) {
    const auto index = static_cast<CalibrationIndex>(i);
    const CalibrationParameter& parameter = parameters.*kEntries[i].parameter;
    priors_[index] = parameter.prior_mean;
    if (!parameter.enabled) continue;
    if (std::ranges::find(supported, index) == supported.end()) {
      throw std::invalid_argument(std::string("calibration.") + kEntries[i].name +
                                  " has no effect on motion model '" + std::string(model) +
                                  "' and cannot be estimated with it");
    }
    specs_.push_back({kEntries[i].name, parameter.prior_mean, parameter.prior_sigma,
                      parameter.random_walk_per_sqrt_s});
    indices_.push_back(index);
  }
}

bool CalibrationLayout::enabled(CalibrationIndex index) const {
  return std::ranges::find(indices_, index) != indices_.end();
}

}  // namespace libslam
