#pragma once
// Points in pairs of images as measurements.

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `measurement.stereo`.
struct StereoNoiseParameters {
  double sigma_pixel = 1.0;
  double sigma_u_left = 0.0, sigma_v_left = 0.0, sigma_u_right = 0.0, sigma_v_right = 0.0;
  int landmark_dimension = 3;

  /// Variance of a coordinate [px^2], `sigma` one of the above.
  double variance(double sigma) const {
    return sigma > 0.0 ? sigma * sigma : sigma_pixel * sigma_pixel;
  }

  void describe(auto& v) {
    v.value("sigma_pixel", sigma_pixel,
            {"px", "Standard deviation of each pixel coordinate of a stereo point.", 1e-6, 1e6});
    v.value("sigma_u_left", sigma_u_left,
            {"px", "The same of the left column alone; 0: sigma_pixel.", 0, 1e6});
    v.value("sigma_v_left", sigma_v_left,
            {"px", "The same of the left row alone; 0: sigma_pixel.", 0, 1e6});
    v.value("sigma_u_right", sigma_u_right,
            {"px", "The same of the right column alone; 0: sigma_pixel.", 0, 1e6});
    v.value("sigma_v_right", sigma_v_right,
            {"px", "The same of the right row alone; 0: sigma_pixel.", 0, 1e6});
    v.value("landmark_dimension", landmark_dimension,
            {"1",
             "Coordinates of a landmark: 3, or 2 for a planar robot with a level camera, which "
             "then uses columns and disparities only.",
             2, 3});
  }
};

}  // namespace libslam
