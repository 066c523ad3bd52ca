#pragma once
// Circular arcs between odometry readings.
//
// A movement (ds, e, dphi) goes ds [m] along an arc that turns by dphi [rad], and e [m] to the left
// of its chord. With h = dphi / 2 the chord has length ds sinc(h), sinc(h) = sin(h) / h, and points
// h off the first heading, so that in the frame of the robot at the start
//
//   (dx, dy) = R(h) (ds sinc(h), e)
//
// This is the exact integral of a constant twist (e = 0), and for |dphi| < 2 pi one-to-one with the
// pose increment (dx, dy, dphi), whatever made it: e is the part that no rolling wheel explains.

#include <Eigen/Core>

namespace libslam {

/// A pose increment (dx, dy, dphi) and its derivative with respect to (ds, e, dphi).
struct ArcIncrement {
  Eigen::Vector3d increment;
  Eigen::Matrix3d jacobian;
};

/// Increment of a movement along an exact arc; smooth through dphi = 0 and for any dphi.
ArcIncrement follow_arc(const Eigen::Vector3d& movement);

/// The same with a chord of length ds: the midpoint rule (S3.1) x + dD cos(theta + dphi / 2).
ArcIncrement follow_chord(const Eigen::Vector3d& movement);

/// Inverse of `follow_arc`. ds is negative where the robot went backwards.
Eigen::Vector3d movement_along_arc(const Eigen::Vector3d& increment);

/// Inverse of `follow_chord`.
Eigen::Vector3d movement_along_chord(const Eigen::Vector3d& increment);

/// Turns x and y by `angle` [rad] and leaves the third coordinate.
Eigen::Matrix3d rotate_planar(double angle);

/// sin(x) / x, 1 at 0.
double sinc(double x);
/// Derivative of `sinc`.
double sinc_derivative(double x);

}  // namespace libslam
