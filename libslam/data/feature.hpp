#pragma once
// One feature as a front-end delivers it: a measurement that a model can predict.

#include <cstdint>

#include <Eigen/Core>

namespace libslam {

/// Largest number of rows of one measurement.
inline constexpr int kMaxMeasurementDimension = 4;

using MeasurementVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxMeasurementDimension, 1>;
using MeasurementMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                        kMaxMeasurementDimension, kMaxMeasurementDimension>;

/// The identity that a sensor gives when it gives none.
inline constexpr std::int64_t kNoIdentity = -1;

/// A measurement in the sensor frame with its noise and where the sensor sits on the robot.
struct Feature {
  std::int64_t id = kNoIdentity;  ///< identity from the sensor, or kNoIdentity
  MeasurementVector z;            ///< range-bearing: range [m], bearing [rad]
  MeasurementMatrix cov;          ///< covariance of z
  Eigen::Vector3d T_robot_sensor = Eigen::Vector3d::Zero();  ///< x [m], y [m], phi [rad]
};

}  // namespace libslam
