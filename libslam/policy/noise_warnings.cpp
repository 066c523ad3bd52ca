#include <iomanip>
#include <sstream>

#include <libslam/policy/noise_warnings.hpp>

namespace libslam {

namespace {

constexpr double kUsual = 3.0;

std::string describe(const AdaptedNoise& noise) {
  std::ostringstream text;
  const std::string unit = noise.unit.empty() ? "" : " " + noise.unit;
  text << std::setprecision(3) << "the sigma of " << noise.name << " was adapted to " << noise.sigma
       << unit << " where " << noise.configured << unit << " was configured: check the "
       << (noise.sigma > noise.configured
               ? "sensor, its configuration and the associations"
               : "configuration; if it is right, the errors are common to many measurements and "
                 "the estimate is surer of itself than it should be");
  return text.str();
}

}  // namespace

std::vector<std::string> warnings_about(std::span<const AdaptedNoise> noise) {
  std::vector<std::string> warnings;
  for (const AdaptedNoise& one : noise)
    if (one.sigma < one.configured / kUsual || one.sigma > one.configured * kUsual)
      warnings.push_back(describe(one));
  return warnings;
}

}  // namespace libslam
