#pragma once
// Noise that is estimated while the filter runs: of the measurements, or of the motion.

#include <string>

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `policies.noise_adaptation`.
struct NoiseAdaptationParameters {
  std::string method = "off";
  double forgetting = 0.96;
  double prior_weight = 20.0;
  int channels = 1;
  bool bias = false;
  double eigenvalue_floor = 0.01;
  double min_sigma_range = 1e-3, max_sigma_range = 100.0, range_growth_per_m = 0.0;
  double min_sigma_bearing_deg = 0.01, max_sigma_bearing_deg = 60.0, bearing_growth_per_m = 0.0;
  double min_sigma_pixel = 0.05, max_sigma_pixel = 200.0, pixel_growth_per_m = 0.0;

  void describe(auto& v) {
    v.value("method", method,
            {"",
             "How the covariance R of the measurements is adapted: residual (Sage-Husa with "
             "residuals after the correction, positive definite by construction), classic "
             "(Sage-Husa with innovations, may lose definiteness and is then repaired; for "
             "comparison), or not at all (off).",
             0,
             0,
             {"off", "residual", "classic"}});
    v.value("forgetting", forgetting,
            {"1", "Weight of the past per update: R remembers about 1 / (1 - forgetting) updates.",
             0.5, 0.99999});
    v.value("prior_weight", prior_weight,
            {"1",
             "The noise that the log or the configuration gives counts like so many measurements "
             "(sightings).",
             1, 1e6});
    v.value("channels", channels,
            {"1",
             "Sensors (labels of the log, in order of appearance) whose noise is adapted apart; "
             "further ones share the last.",
             1, 100});
    v.value("bias", bias,
            {"", "Estimate a constant offset of the measurements, too; needs a known map."});
    v.value(
        "eigenvalue_floor", eigenvalue_floor,
        {"1",
         "Method classic alone: the adapted R is repaired so that no variance, in any direction, "
         "falls below so many times the configured one (a ratio of variances: 0.01 is a tenth "
         "of sigma). Lower it if the sensor may be more than ten times better than "
         "configured, raise it towards 1 if R collapses; 0: no repair, the filter then "
         "rejects what it cannot use.",
         0, 1});
    v.value("min_sigma_range", min_sigma_range, {"m", "Floor of a range's sigma.", 1e-9});
    v.value("max_sigma_range", max_sigma_range, {"m", "Ceiling of a range's sigma.", 1e-9});
    v.value("range_growth_per_m", range_growth_per_m,
            {"1/m",
             "Known shape: sigma of a range is multiplied by 1 + range_growth_per_m * range.", 0});
    v.value("min_sigma_bearing_deg", min_sigma_bearing_deg,
            {"deg", "Floor of a bearing's sigma.", 1e-9});
    v.value("max_sigma_bearing_deg", max_sigma_bearing_deg,
            {"deg", "Ceiling of a bearing's sigma.", 1e-9});
    v.value(
        "bearing_growth_per_m", bearing_growth_per_m,
        {"1/m",
         "Known shape: sigma of a bearing is multiplied by 1 + bearing_growth_per_m * range.", 0});
    v.value("min_sigma_pixel", min_sigma_pixel,
            {"px", "Floor of the sigmas of column, row and disparity of a stereo point.", 1e-6});
    v.value("max_sigma_pixel", max_sigma_pixel,
            {"px", "Ceiling of the sigmas of column, row and disparity of a stereo point.", 1e-6});
    v.value(
        "pixel_growth_per_m", pixel_growth_per_m,
        {"1/m", "Known shape: sigma in the images is multiplied by 1 + pixel_growth_per_m * depth.",
         0});
  }
};

/// Section `policies.process_adaptation`.
struct ProcessAdaptationParameters {
  std::string method = "off";
  double forgetting = 0.99;
  double prior_weight = 50.0;
  double min_factor = 0.01, max_factor = 100.0;

  void describe(auto& v) {
    v.value("method", method,
            {"",
             "How the covariance Q of the odometry is adapted: by one factor on all of it, which "
             "stays positive by construction (scale), or not at all (off). An offset of the "
             "odometry is a matter of `calibration`.",
             0,
             0,
             {"off", "scale"}});
    v.value("forgetting", forgetting, {"1", "Weight of the past per update.", 0.5, 0.99999});
    v.value("prior_weight", prior_weight, {"1", "Factor 1 counts like so many updates.", 1, 1e6});
    v.value("min_factor", min_factor, {"1", "Floor of the factor on Q.", 1e-6});
    v.value("max_factor", max_factor, {"1", "Ceiling of the factor on Q.", 1e-6});
  }
};

}  // namespace libslam
