#include <cmath>

#include <Eigen/Geometry>

#include <libslam/motion/arc.hpp>

namespace libslam {

namespace {

// Below this angle the series are exact to double precision (the next terms are below 1e-17), while
// the closed form of the derivative cancels.
constexpr double kSeriesBelow = 1e-3;

/// Increment for a chord of the given length with derivatives of the chord by ds and by dphi.
ArcIncrement rotate_chord(const Eigen::Vector3d& movement, double chord, double chord_by_ds,
                          double chord_by_turn) {
  const double half = 0.5 * movement[2];
  const Eigen::Vector2d forward(std::cos(half), std::sin(half));
  const Eigen::Vector2d left(-forward.y(), forward.x());
  ArcIncrement result;
  result.increment << chord * forward + movement[1] * left, movement[2];
  result.jacobian.setIdentity();
  result.jacobian.col(0).head<2>() = chord_by_ds * forward;
  result.jacobian.col(1).head<2>() = left;
  result.jacobian.col(2).head<2>() =
      chord_by_turn * forward + 0.5 * (chord * left - movement[1] * forward);
  return result;
}

}  // namespace

Eigen::Matrix3d rotate_planar(double angle) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(angle).toRotationMatrix();
  return rotation;
}

double sinc(double x) {
  if (std::abs(x) >= kSeriesBelow) return std::sin(x) / x;
  const double x2 = x * x;
  return 1.0 - x2 / 6.0 * (1.0 - x2 / 20.0);
}

double sinc_derivative(double x) {
  if (std::abs(x) >= kSeriesBelow) return (std::cos(x) - std::sin(x) / x) / x;
  const double x2 = x * x;
  return -x / 3.0 * (1.0 - x2 / 10.0);
}

ArcIncrement follow_arc(const Eigen::Vector3d& movement) {
  const double half = 0.5 * movement[2];
  const double ratio = sinc(half);
  return rotate_chord(movement, movement[0] * ratio, ratio,
                      0.5 * movement[0] * sinc_derivative(half));
}

ArcIncrement follow_chord(const Eigen::Vector3d& movement) {
  return rotate_chord(movement, movement[0], 1.0, 0.0);
}

Eigen::Vector3d movement_along_chord(const Eigen::Vector3d& increment) {
  Eigen::Vector3d movement;
  movement << Eigen::Rotation2Dd(-0.5 * increment[2]) * increment.head<2>(), increment[2];
  return movement;
}

Eigen::Vector3d movement_along_arc(const Eigen::Vector3d& increment) {
  Eigen::Vector3d movement = movement_along_chord(increment);
  movement[0] /= sinc(0.5 * increment[2]);
  return movement;
}

}  // namespace libslam
