#include <libslam/config/rules/rules.hpp>

namespace libslam {

void check_map(const Parameters& p, Conflicts& conflicts) {
  if (p.map.file.empty()) {
    return;
  }
  if (p.filter.linearization != "estimate") {
    conflicts.push_back({{"map.file", "filter.linearization"},
                         "a map does not hold the points of linearization of the run that made it; "
                         "only the estimate is left"});
  }
  if (p.measurement.model == "sensor_displacement") {
    conflicts.push_back({{"map.file", "measurement.model"}, "displacements see no landmarks"});
  }
}

}  // namespace libslam
