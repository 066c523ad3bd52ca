#pragma once
// The best possible calibration: nonlinear least squares over all displacements of a log (Ceres).

#include <map>
#include <string>

#include <libslam/io/importers/imported_log.hpp>

namespace libslam::test {

struct BatchCalibration {
  std::map<std::string, double> mean, sigma;  ///< by the names of the calibration blocks
  double trimmed = 0.0;                       ///< fraction of displacements left out as failed
};

/// Fits scale_left, scale_right, track_width (on odometry made with a track of `nominal_track`
/// [m]), sensor_x, sensor_y, sensor_phi to the displacements between successive poses of
/// `log.sensor_path`, from `start`. Failed scan matches are trimmed at four robust standard
/// deviations (1.4826 MAD per coordinate), which are the noise that `sigma` is computed with: no
/// figure of the filter's configuration enters.
BatchCalibration fit_calibration(const ImportedLog& log, double nominal_track,
                                 const std::map<std::string, double>& start);

}  // namespace libslam::test
