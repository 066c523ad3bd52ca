#pragma once
// What is read from the log.

#include <string>

#include <libslam/config/description.hpp>
#include <libslam/config/parameters/scan_matching.hpp>

namespace libslam {

/// Section `input`: what is read from the log.
struct InputParameters {
  std::string policy = "skip";
  std::string odometry = "auto";
  std::string odometry_label = "";
  std::string sensor_label = "";
  double velocity_tolerance = 0.2;
  ScanMatchingParameters scan_matching;

  void describe(auto& v) {
    v.value("policy", policy,
            {"",
             "What to do with an unusable entry of the log: stop, leave it out, or mend what can "
             "be mended.",
             0,
             0,
             {"strict", "skip", "repair"}});
    v.value("odometry", odometry,
            {"",
             "Field of the log that drives the motion model; auto takes pose increments; twist: "
             "body velocities in space; none ignores odometry.",
             0,
             0,
             {"auto", "increments", "velocities", "ticks", "twist", "none"}});
    v.value("odometry_label", odometry_label,
            {"", "Use only odometry observations with this sensor label; empty: all."});
    v.value("sensor_label", sensor_label,
            {"", "Use only landmark observations with this sensor label; empty: all."});
    v.value("velocity_tolerance", velocity_tolerance,
            {"1",
             "Velocities or ticks of the log are used only if, over the first readings, they agree "
             "with its pose increments within this fraction.",
             0, 10});
    v.section("scan_matching", scan_matching);
  }
};

}  // namespace libslam
