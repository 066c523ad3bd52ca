#pragma once
// Displacement of a sensor on the robot, from scan matching or visual odometry.
//
//   d = x_before^-1 (+) x_now      robot displacement (dx, dy, dphi)
//   h = l^-1 (+) d (+) l = [ R(-l_phi) (R(dphi) l_xy + d_xy - l_xy) ;  dphi ]
//   z = s_before^-1 (+) s_now      s: readings, poses of the sensor on its own path
//
// with l = T_robot_sensor = (sensor_x, sensor_y, sensor_phi) [m, m, rad], each a block of the state
// or a constant. Without turns l_xy is invisible (dphi = 0: its column vanishes), without
// translation l_phi acts through l_xy alone.
// Source: Censi, Franchi, Marchionni, Oriolo, "Simultaneous calibration of odometry and sensor
// parameters for mobile robots", IEEE T-RO 29(2), 2013, eq. (4).

#include <libslam/config/parameters.hpp>
#include <libslam/measurement/displacement_model.hpp>

namespace libslam {

class SensorDisplacement final : public DisplacementModel {
 public:
  /// Uses sensor_x, sensor_y and sensor_phi: the prior mean is the value of what is not enabled.
  explicit SensorDisplacement(const CalibrationParameters& calibration);

  const std::vector<CalibrationSpec>& calibration() const override { return specs_; }
  /// h(x) [m, m, rad].
  MeasurementVector predict(const GaussianState& state, const PosePair& poses,
                            const CalibrationBlocks& blocks) const;
  /// The noise is that of `now`.
  void linearize(const GaussianState& state, const PosePair& poses, const CalibrationBlocks& blocks,
                 const Feature& before, const Feature& now,
                 LinearizedMeasurement& out) const override;
  /// The sensor's position shows in turns, its direction in translation.
  Eigen::Matrix3Xd excitation(const Eigen::Vector3d& movement) const override;

 private:
  /// T_robot_sensor with the estimates of the blocks.
  Eigen::Vector3d sensor_pose(const GaussianState& state, const CalibrationBlocks& blocks) const;

  Eigen::Vector3d T_robot_sensor_;      // prior means
  std::vector<CalibrationSpec> specs_;  // what is estimated
  std::vector<Eigen::Index> indices_;   // of `specs_` in T_robot_sensor
};

}  // namespace libslam
