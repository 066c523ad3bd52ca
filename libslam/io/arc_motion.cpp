#include <cmath>

#include <Eigen/Geometry>

#include <libslam/io/arc_motion.hpp>

namespace libslam {
namespace {

/// Chord over arc of a turn of 2 a.
double sinc(double a) {
  return std::abs(a) < 1e-4 ? 1.0 - a * a / 6.0 : std::sin(a) / a;
}

}  // namespace

Eigen::Vector3d increment_of_arc(const Eigen::Vector3d& arc) {
  const double half = arc.z() / 2;
  const Eigen::Vector2d chord = Eigen::Rotation2Dd(half) * (sinc(half) * arc.head<2>());
  return {chord.x(), chord.y(), arc.z()};
}

Eigen::Vector3d arc_of_increment(const Eigen::Vector3d& increment) {
  const double half = increment.z() / 2;
  const Eigen::Vector2d path = Eigen::Rotation2Dd(-half) * (increment.head<2>() / sinc(half));
  return {path.x(), path.y(), increment.z()};
}

}  // namespace libslam
