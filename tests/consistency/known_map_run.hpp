#pragma once
// Localization in a known map on simulated drives, filter by filter on the same logs.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <libslam/config/parameters.hpp>
#include <libslam/simulation/scenario.hpp>

namespace libslam::test {

struct LocalizationFilter {
  Parameters parameters;              ///< complete
  bool knows_the_noise_step = false;  ///< is given the true R at every time
};

/// One filter, over many drives.
struct LocalizationFigures {
  double rmse_position = 0.0;  ///< over all observations of all drives [m]
  double nees = 0.0;           ///< of the pose, mean; ideal 3
  int unused = 0;              ///< observations without a correction, or with an unhealthy filter
  /// Adapted sigma of the range [m], mean over the drives, by observation.
  std::vector<double> sigma_range;
};

/// Drives with seeds `first_seed` and on; `filters` by name.
std::map<std::string, LocalizationFigures> localize(
    const Scenario& scenario, const std::map<std::string, LocalizationFilter>& filters, int drives,
    std::uint64_t first_seed = 1);

}  // namespace libslam::test
