#pragma once
// Filters whose response to disturbances is under test, whatever they measure.

#include <memory>

#include <Eigen/Core>

#include <libslam/association/known.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/motion/odometry_increment.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam::testing {

/// A planar robot in the right-invariant frame that knows the identities of what it sees, with
/// gates of .999, and answers to disturbances of 1 m and .2 rad.
inline EkfSlamParts disturbance_parts(std::unique_ptr<MeasurementModel> measurement, int rows,
                                      const ResponseOptions& response) {
  EkfSlamParts parts;
  parts.motion = std::make_unique<OdometryIncrement>(MotionParameters{}, CalibrationParameters{});
  parts.measurement = std::move(measurement);
  parts.associator = std::make_unique<KnownAssociation>(chi_square_quantile(0.999, rows));
  parts.frame = make_error_frame("right_invariant");
  DisturbanceOptions options;
  options.sigma = Eigen::Vector3d(1.0, 1.0, 0.2);
  parts.disturbance.emplace(Disturbance(options), response);
  return parts;
}

}  // namespace libslam::testing
