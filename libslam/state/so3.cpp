#include <cmath>

#include <libslam/state/so3.hpp>

namespace libslam {

namespace {

/// Below this angle the quotients lose digits and their series need five terms.
constexpr double kSmallAngle = 0.3;

/// The coefficients a and b, and their derivatives by t over t.
struct Coefficients {
  double a, b, da, db;
};

Coefficients series(double t2) {
  const auto sum = [t2](double c0, double c1, double c2, double c3, double c4) {
    return c0 + t2 * (c1 + t2 * (c2 + t2 * (c3 + t2 * c4)));
  };
  return {sum(1.0 / 2, -1.0 / 24, 1.0 / 720, -1.0 / 40320, 1.0 / 3628800),
          sum(1.0 / 6, -1.0 / 120, 1.0 / 5040, -1.0 / 362880, 1.0 / 39916800),
          sum(-1.0 / 12, 1.0 / 180, -1.0 / 6720, 1.0 / 453600, -1.0 / 47900160),
          sum(-1.0 / 60, 1.0 / 1260, -1.0 / 60480, 1.0 / 4989600, -1.0 / 622702080)};
}

Coefficients coefficients(double t) {
  if (t < kSmallAngle) return series(t * t);
  const double sine = std::sin(t), cosine = std::cos(t), t2 = t * t;
  return {(1.0 - cosine) / t2, (t - sine) / (t2 * t), (t * sine - 2.0 + 2.0 * cosine) / (t2 * t2),
          (3.0 * sine - t * cosine - 2.0 * t) / (t2 * t2 * t)};
}

}  // namespace

Eigen::Quaterniond so3_exp(const Eigen::Vector3d& theta) {
  const double angle = theta.norm();
  const double half_sinc =
      angle < 1e-8 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  const Eigen::Vector3d v = half_sinc * theta;
  return {std::cos(0.5 * angle), v.x(), v.y(), v.z()};
}

Eigen::Vector3d so3_log(Eigen::Quaterniond q) {
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-9) return 2.0 * q.vec();
  return 2.0 * std::atan2(sine, q.w()) / sine * q.vec();
}

Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& theta) {
  const Coefficients c = coefficients(theta.norm());
  const Eigen::Matrix3d cross = skew(theta);
  return Eigen::Matrix3d::Identity() + c.a * cross + c.b * cross * cross;
}

Eigen::Matrix3d so3_left_jacobian_derivative(const Eigen::Vector3d& theta,
                                             const Eigen::Vector3d& u) {
  const Coefficients c = coefficients(theta.norm());
  const Eigen::Vector3d once = theta.cross(u), twice = theta.cross(once);
  return (c.da * once + c.db * twice) * theta.transpose() - c.a * skew(u) -
         c.b * (skew(once) + skew(theta) * skew(u));
}

}  // namespace libslam
