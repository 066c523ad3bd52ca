#pragma once
// A point in a calibrated, rectified stereo pair.
//
//   p_c = T_world_camera^-1 m,   z = (u, v, d) = (cx + fx X/Z, cy + fy Y/Z, fx b/Z)
//
// with p_c = (X, Y, Z) in the left camera (X right, Y down, Z along the axis) and T_world_camera =
// T_world_robot T_robot_camera. Units px and m; Feature::camera holds the camera and its pose on
// the robot, Feature::cov the covariance of (u, v, d), whose u and d are correlated. With d, not
// the depth, as measurement the noise is Gaussian at every distance.
//
// | robot | landmark | rows    | note |
// |-------|----------|---------|-------------------------------------------------------------------|
// | SE3   | x, y, z  | u, v, d | | | SE2   | x, y, z  | u, v, d | heights relative to the ground |
// | SE2   | x, y     | u, d    | the row says nothing without a height; the camera must be level: |
// |       |          |         | u and d do not depend on the height then |
//
// Source: Barfoot, State Estimation for Robotics, 2017, section 6.4.3 (disparity form).

#include <libslam/measurement/measurement_model.hpp>

namespace libslam {

class StereoPoint final : public MeasurementModel {
 public:
  /// `dimension`: coordinates of a landmark, 2 or 3; throws std::invalid_argument otherwise. Every
  /// method below throws std::invalid_argument where a feature has no camera, or where landmarks
  /// have two coordinates and the camera is not level.
  explicit StereoPoint(int dimension);

  BlockSpec landmark_spec() const override;
  /// NaN where the landmark is not in front of the camera.
  MeasurementVector predict(const GaussianState& state, BlockId pose, BlockId landmark,
                            const Feature& feature) const override;
  void linearize(const GaussianState& state, BlockId pose, BlockId landmark, const Feature& feature,
                 LinearizedMeasurement& out) const override;
  /// The disparity is positive and known to a third: beyond that the depth has a tail to infinity.
  bool initializable(const Feature& feature) const override;
  bool bounded_in_map() const override { return false; }
  void initialize(const GaussianState& state, BlockId pose, const Feature& feature,
                  Initialization& out) const override;

 private:
  void check(const GaussianState& state, BlockId pose, const Feature& feature) const;

  int dimension_;
};

}  // namespace libslam
