#pragma once
// Trunks and other upright cylinders in the scans of a laser.

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `frontend.trunks`.
struct TrunkParameters {
  double range_bias = 0.0;
  double jump = 1.5;
  double gap_deg = 5.0;
  double isolation = 3.0;
  double min_diameter = 0.0;
  double max_diameter = 1.0;
  double known_diameter = 0.0;
  int min_beams = 2;
  double margin_deg = 2.5;
  double skew = 0.35;
  double sigma_range = 0.02;
  double sigma_centre = 0.05;

  void describe(auto& v) {
    v.value("range_bias", range_bias,
            {"m", "The laser's ranges are too long by this; negative: too short.", -10, 10});
    v.value("jump", jump,
            {"m",
             "Neighbouring beams belong to two objects where their ranges differ by more; the "
             "nearer one hides the edge of the other.",
             1e-3, 100});
    v.value("gap_deg", gap_deg,
            {"deg",
             "Beams without return between two parts of one object fill at most this angle; 0: "
             "they end it.",
             0, 90});
    v.value(
        "isolation", isolation,
        {"m", "Next to a trunk, the laser sees nothing that is nearer to it than this.", 0, 100});
    v.value("min_diameter", min_diameter, {"m", "Thinner objects are no trunks.", 0, 100});
    v.value("max_diameter", max_diameter, {"m", "Thicker objects are no trunks.", 1e-3, 100});
    v.value(
        "known_diameter", known_diameter,
        {"m", "Diameter that all of them have; 0: it follows from the angle they fill.", 0, 100});
    v.value("min_beams", min_beams, {"1", "Fewer beams on an object are no trunk.", 1, 10000});
    v.value("margin_deg", margin_deg,
            {"deg", "Objects that come nearer to an end of the scan may be cut off.", 0, 90});
    v.value("skew", skew,
            {"1",
             "The two edges of a trunk differ in range by at most this part of its diameter; those "
             "of a wall or a bush differ by more.",
             0, 100});
    v.value("sigma_range", sigma_range,
            {"m", "Standard deviation of the range of one beam (measurement.noise: auto).", 1e-6});
    v.value("sigma_centre", sigma_centre,
            {"m",
             "Standard deviation that is added to the centre along and across: trunks are not "
             "round (measurement.noise: auto).",
             0});
  }
};

}  // namespace libslam
