#pragma once
// One feature as a front-end delivers it: a measurement that a model can predict.

#include <cstdint>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include <libslam/data/descriptor.hpp>
#include <libslam/data/extent.hpp>
#include <libslam/data/stereo_camera.hpp>

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
  int channel = 0;                ///< sensor it comes from: noise is adapted per channel
  MeasurementVector z;    ///< range-bearing: range [m], bearing [rad]; stereo: u, v, d [px];
                          ///< line: alpha [rad], r [m]
  MeasurementMatrix cov;  ///< covariance of z
  Eigen::Vector3d T_robot_sensor = Eigen::Vector3d::Zero();  ///< x [m], y [m], phi [rad]
  std::shared_ptr<const StereoCamera> camera;                ///< of a stereo point, else null
  std::shared_ptr<const Descriptor> appearance;              ///< null: not known
  std::optional<Extent> extent;  ///< of a line, in the frame of the sensor
};

}  // namespace libslam
