#pragma once
// An oriented straight line (a wall seen from one side) in Hesse form.
//
//   n(alpha) = (cos alpha, sin alpha),   n^T p = r;   t(alpha) = J n, a quarter turn left of n
//   T_world_sensor = (p_s, theta_s) = T_world_robot T_robot_sensor
//   h = [ wrap(alpha_w - theta_s) ;  r_w - n(alpha_w)^T p_s ]                         (S2.a)
//
// Measurement: alpha [rad] and r [m] in the frame of the sensor. Landmark block (Chart::kLine):
// alpha_w, r_w in the world. The normal points from the sensor to the wall, so that r > 0 in a
// measurement while r_w has either sign. Nothing is ever flipped to a canonical sign (S2.a and S2.b
// ask for r >= 0): that would turn rows and columns of P, and the two sides of a thin wall, half a
// turn apart here, would become one line.

#include <libslam/measurement/measurement_model.hpp>

namespace libslam {

/// How well two estimates of one wall agree beyond their covariances: walls are not straight.
struct LineTolerance {
  double sigma_alpha = 0.02;  ///< [rad]
  double sigma_r = 0.03;      ///< where the two are compared [m]
};

class LineMeasurement final : public MeasurementModel {
 public:
  explicit LineMeasurement(const LineTolerance& tolerance = {}) : tolerance_(tolerance) {}

  BlockSpec landmark_spec() const override;
  std::string_view landmark_type() const override { return "line"; }
  MeasurementVector predict(const GaussianState& state, BlockId pose, BlockId landmark,
                            const Feature& feature) const override;
  /// The innovation of alpha is wrapped to (-pi, pi].
  void linearize(const GaussianState& state, BlockId pose, BlockId landmark, const Feature& feature,
                 LinearizedMeasurement& out) const override;
  bool bounded_in_map() const override { return false; }
  void initialize(const GaussianState& state, BlockId pose, const Feature& feature,
                  Initialization& out) const override;
  /// Nothing for a feature without an extent. The ends are those of the feature, carried to the
  /// world by the estimate of the pose and dropped onto the line.
  std::optional<Extent> sighted_part(const GaussianState& state, BlockId pose, BlockId landmark,
                                     const Feature& feature) const override;
  /// Not for lines more than kMaxTurn apart, which also tells the two sides of a wall. The noise
  /// is the tolerance at the middle of the part that both have in common, or of the gap.
  bool difference(const GaussianState& state, const LandmarkPart& a, const LandmarkPart& b,
                  double extent_gap, LinearizedMeasurement& out) const override;
  std::optional<Extent> part_along(const GaussianState& state, BlockId landmark,
                                   const LandmarkPart& part) const override;

 private:
  static constexpr double kMaxTurn = 0.5;  // [rad]
  LineTolerance tolerance_;
};

}  // namespace libslam
