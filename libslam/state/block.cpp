#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/Geometry>

#include <libslam/state/block.hpp>
#include <libslam/state/so3.hpp>

namespace libslam {

namespace {

Eigen::Quaterniond rotation_of(const VectorRef& pose3d) {
  return {pose3d[6], pose3d[3], pose3d[4], pose3d[5]};
}

}  // namespace

double wrap_angle(double angle) {
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  const double wrapped = angle - kTwoPi * std::round(angle / kTwoPi);
  return wrapped <= -std::numbers::pi ? wrapped + kTwoPi : wrapped;
}

int tangent_dimension(const BlockSpec& spec) {
  switch (spec.chart) {
    case Chart::kVector:
      return spec.size;
    case Chart::kAngle:
      return 1;
    case Chart::kSE2:
      return 3;
    case Chart::kLine:
      return 2;
    case Chart::kSE3:
      return 6;
  }
  throw std::invalid_argument("block '" + spec.name + "': unknown chart");
}

int storage_dimension(const BlockSpec& spec) {
  return spec.chart == Chart::kSE3 ? 7 : tangent_dimension(spec);
}

void boxplus(const BlockSpec& spec, Eigen::Ref<Eigen::VectorXd> x, const VectorRef& d) {
  switch (spec.chart) {
    case Chart::kVector:
      x += d;
      return;
    case Chart::kAngle:
      x[0] = wrap_angle(x[0] + d[0]);
      return;
    case Chart::kSE2:
      x.head<2>() += d.head<2>();
      x[2] = wrap_angle(x[2] + d[2]);
      return;
    case Chart::kLine:
      x[0] = wrap_angle(x[0] + d[0]);
      x[1] += d[1];
      return;
    case Chart::kSE3:
      x.head<3>() += d.head<3>();
      x.tail<4>() = (so3_exp(d.tail<3>()) * rotation_of(x)).normalized().coeffs();
      return;
  }
}

TangentVector boxminus(const BlockSpec& spec, const VectorRef& a, const VectorRef& b) {
  TangentVector d;
  switch (spec.chart) {
    case Chart::kVector:
      d = a - b;
      break;
    case Chart::kAngle:
      d = TangentVector::Constant(1, wrap_angle(a[0] - b[0]));
      break;
    case Chart::kSE2:
      d = a - b;
      d[2] = wrap_angle(d[2]);
      break;
    case Chart::kLine:
      d = a - b;
      d[0] = wrap_angle(d[0]);
      break;
    case Chart::kSE3:
      d.resize(6);
      d.head<3>() = a.head<3>() - b.head<3>();
      d.tail<3>() = so3_log(rotation_of(a) * rotation_of(b).conjugate());
      break;
  }
  return d;
}

}  // namespace libslam
