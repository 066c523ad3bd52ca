#pragma once
// Front-ends and measurement models.

#include <string>

#include <libslam/config/description.hpp>
#include <libslam/config/parameters/scan_lines.hpp>
#include <libslam/config/parameters/stereo.hpp>
#include <libslam/config/parameters/stereo_noise.hpp>
#include <libslam/config/parameters/trunks.hpp>

namespace libslam {

/// Section `frontend`.
struct FrontendParameters {
  std::string source = "range_bearing";
  double min_range = 0.0;
  double max_range = 1e6;
  ScanLinesParameters lines;
  StereoFrontendParameters stereo;
  FiducialParameters fiducials;
  TrunkParameters trunks;

  void describe(auto& v) {
    v.value(
        "source", source,
        {"",
         "Where features come from: range-bearing observations, the path that a sensor reports "
         "of itself (odometry observations labelled input.sensor_label), logged points of a "
         "stereo camera, points of its images, tags in its images, straight lines or trunks in the "
         "scans of a laser.",
         0,
         0,
         {"range_bearing", "sensor_path", "stereo_points", "stereo_images", "fiducials",
          "scan_lines", "scan_trunks"}});
    v.value("min_range", min_range,
            {"m", "Nearer observations are ignored; of stereo points by their depth.", 0});
    v.value("max_range", max_range, {"m", "Farther observations are ignored.", 0});
    v.section("lines", lines);
    v.section("stereo", stereo);
    v.section("fiducials", fiducials);
    v.section("trunks", trunks);
  }
};

/// Section `measurement`.
struct MeasurementParameters {
  std::string model = "range_bearing";
  std::string noise = "auto";
  double sigma_range = 0.1;
  double sigma_bearing_deg = 1.0;
  double sigma_displacement_xy = 0.001;
  double sigma_displacement_heading_deg = 0.1;
  StereoNoiseParameters stereo;

  void describe(auto& v) {
    v.value(
        "model", model,
        {"",
         "Measurement model: of landmarks by range and bearing, as points of a stereo camera or as "
         "straight lines, or of the displacement of a sensor (no map).",
         0,
         0,
         {"range_bearing", "stereo_point", "line", "sensor_displacement"}});
    v.value(
        "noise", noise,
        {"",
         "Noise of an observation: per-observation covariance of the log where it has one, the "
         "log's sensor sigmas, else the configured sigmas (auto), or always the configured ones.",
         0,
         0,
         {"auto", "configured"}});
    v.value("sigma_range", sigma_range, {"m", "Standard deviation of a range.", 1e-9});
    v.value("sigma_bearing_deg", sigma_bearing_deg,
            {"deg", "Standard deviation of a bearing.", 1e-9});
    v.value("sigma_displacement_xy", sigma_displacement_xy,
            {"m", "Standard deviation of a sensor's displacement along x and y, each.", 1e-9});
    v.value("sigma_displacement_heading_deg", sigma_displacement_heading_deg,
            {"deg", "Standard deviation of the turn of a displacement.", 1e-9});
    v.section("stereo", stereo);
  }
};

}  // namespace libslam
