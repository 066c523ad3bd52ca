#pragma once
// Every parameter of a run: its default, unit, range and one sentence, in one place.
//
// Each struct describes itself to a visitor; the YAML loader, `--help-config`, `--set`, the
// effective configuration and config/README.md are all visits of the same description.

#include <libslam/config/parameters/association.hpp>
#include <libslam/config/parameters/calibration.hpp>
#include <libslam/config/parameters/filter.hpp>
#include <libslam/config/parameters/input.hpp>
#include <libslam/config/parameters/map.hpp>
#include <libslam/config/parameters/measurement.hpp>
#include <libslam/config/parameters/motion.hpp>
#include <libslam/config/parameters/output.hpp>
#include <libslam/config/parameters/policies.hpp>

namespace libslam {

inline constexpr double kPi = 3.141592653589793;

/// A complete run.
struct Parameters {
  InputParameters input;
  MotionParameters motion;
  CalibrationParameters calibration;
  FrontendParameters frontend;
  MeasurementParameters measurement;
  AssociationParameters association;
  FilterParameters filter;
  PolicyParameters policies;
  MapParameters map;
  OutputParameters output;

  void describe(auto& v) {
    v.section("input", input);
    v.section("motion", motion);
    v.section("calibration", calibration);
    v.section("frontend", frontend);
    v.section("measurement", measurement);
    v.section("association", association);
    v.section("filter", filter);
    v.section("policies", policies);
    v.section("map", map);
    v.section("output", output);
  }
};

}  // namespace libslam
