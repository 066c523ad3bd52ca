#pragma once
// Range and bearing to a planar point landmark, from a sensor anywhere on the robot.
//
//   T_world_sensor = T_world_robot * T_robot_sensor,  l = landmark in the sensor frame
//   h = [ |l| ;  atan2(l_y, l_x) ]          (seeds.md S1.7, there with the sensor at the robot
//   origin)
//
// Measurement: range [m], bearing [rad, counter-clockwise from the sensor's x axis].
// Landmark block: (x, y) in the world [m].

#include <libslam/measurement/measurement_model.hpp>

namespace libslam {

class RangeBearing final : public MeasurementModel {
 public:
  BlockSpec landmark_spec() const override;
  MeasurementVector predict(const GaussianState& state, BlockId pose, BlockId landmark,
                            const Feature& feature) const override;
  /// The innovation's bearing is wrapped to (-pi, pi]. Derivatives of a landmark closer than 1e-6 m
  /// to the sensor are those at 1e-6 m, where they are finite.
  void linearize(const GaussianState& state, BlockId pose, BlockId landmark, const Feature& feature,
                 LinearizedMeasurement& out) const override;
  void initialize(const GaussianState& state, BlockId pose, const Feature& feature,
                  Initialization& out) const override;
};

}  // namespace libslam
