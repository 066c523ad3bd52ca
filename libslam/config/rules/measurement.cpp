#include <utility>

#include <libslam/config/rules/rules.hpp>

namespace libslam {

void check_frontend(const Parameters& p, Conflicts& conflicts) {
  if (p.frontend.min_range >= p.frontend.max_range) {
    conflicts.push_back({{"frontend.min_range", "frontend.max_range"},
                         "no observation lies between a nearest and a farthest range in this "
                         "order"});
  }
  if (p.frontend.source != "scan_trunks") return;
  if (p.frontend.trunks.min_diameter >= p.frontend.trunks.max_diameter) {
    conflicts.push_back({{"frontend.trunks.min_diameter", "frontend.trunks.max_diameter"},
                         "no trunk lies between a thinnest and a thickest one in this order"});
  }
  if (p.association.method == "known") {
    conflicts.push_back({{"frontend.source", "association.method"},
                         "trunks in a scan have no identities; associate them by their place"});
  }
  if (p.measurement.model != "range_bearing" && p.measurement.model != "sensor_displacement") {
    conflicts.push_back(
        {{"frontend.source", "measurement.model"}, "trunks are seen by range and bearing"});
  }
}

void check_displacement(const Parameters& p, Conflicts& conflicts) {
  const bool measures = p.measurement.model == "sensor_displacement";
  if (measures != (p.frontend.source == "sensor_path")) {
    conflicts.push_back(
        {{"measurement.model", "frontend.source"},
         "sensor_displacement measures along a sensor_path, and nothing else does"});
  }
  for (const auto& [name, parameter] :
       {std::pair("calibration.sensor_x.enabled", &p.calibration.sensor_x),
        std::pair("calibration.sensor_y.enabled", &p.calibration.sensor_y),
        std::pair("calibration.sensor_phi.enabled", &p.calibration.sensor_phi)}) {
    if (parameter->enabled && !measures) {
      conflicts.push_back({{name, "measurement.model"},
                           "landmark models take the pose of the sensor from the log; only "
                           "sensor_displacement estimates it"});
    }
  }
  if (!measures) {
    return;
  }
  if (p.input.sensor_label.empty()) {
    conflicts.push_back({{"input.sensor_label", "measurement.model"},
                         "the label tells the path of the sensor from the odometry of the robot"});
  }
  if (p.input.sensor_label == p.input.odometry_label && !p.input.sensor_label.empty()) {
    conflicts.push_back({{"input.sensor_label", "input.odometry_label"},
                         "the odometry of the robot cannot be its own measurement"});
  }
  if (p.input.odometry == "none") {
    conflicts.push_back({{"measurement.model", "input.odometry"},
                         "without odometry there is nothing to compare a displacement with"});
  }
  if (p.filter.linearization != "estimate") {
    conflicts.push_back({{"filter.linearization", "measurement.model"},
                         "displacements are linearized at the estimate"});
  }
}

}  // namespace libslam
