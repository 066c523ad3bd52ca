#include <algorithm>
#include <cmath>

#include <libslam/frontend/scan_surface.hpp>

namespace libslam {

namespace {

constexpr double kReach = 0.15;          // of a neighbourhood to either side [m]
constexpr int kFewest = 2;               // neighbours on a side, however far
constexpr int kMost = 20;                // neighbours on a side
constexpr double kJump = 0.3;            // no surface goes on across a gap of this [m] ...
constexpr double kGrazing = 5.0;         // ... and of so many spacings of beams on a wall ahead
constexpr double kRoughest = 0.05;       // spread across a line [m]
constexpr double kSlenderness = 25.0;    // variance along a line per variance across
constexpr double kSmallestVar = 2.5e-5;  // across a line: (5 mm)^2, ranges are rounded

/// The last of at most kMost neighbours of `at` in the direction of `step`.
std::size_t reach(std::span<const BeamPoint> points, std::size_t at, std::ptrdiff_t step) {
  const double range = points[at].range;
  std::size_t last = at;
  for (int count = 0; count < kMost; ++count) {
    const std::size_t next = last + static_cast<std::size_t>(step);  // wraps below 0
    if (next >= points.size()) break;
    const double spacing = range * std::abs(points[next].bearing - points[last].bearing);
    if ((points[next].p - points[last].p).norm() > std::max(kJump, kGrazing * spacing)) break;
    if (count >= kFewest && (points[next].p - points[at].p).norm() > kReach) break;
    last = next;
  }
  return last;
}

/// Fills the line through `neighbours`, in the frame of the sensor, if they are on one.
void fit_line(std::span<const BeamPoint> neighbours, SurfacePoint& point) {
  if (neighbours.size() < 3) return;
  const auto count = static_cast<double>(neighbours.size());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const BeamPoint& other : neighbours) mean += other.p;
  mean /= count;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const BeamPoint& other : neighbours) {
    const Eigen::Vector2d d = other.p - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const double alpha = 0.5 * std::atan2(-2.0 * xy, yy - xx);
  const Eigen::Vector2d n(std::cos(alpha), std::sin(alpha));
  const double across = n.x() * n.x() * xx + 2.0 * n.x() * n.y() * xy + n.y() * n.y() * yy;
  const double along = xx + yy - across;
  if (across > count * kRoughest * kRoughest || along < kSlenderness * across || along <= 0.0)
    return;
  point.smooth = true;
  point.n = n.dot(mean) < 0.0 ? Eigen::Vector2d(-n) : n;
  point.foot = mean;
  point.var_turn = std::max(across / count, kSmallestVar) / along;
}

}  // namespace

void find_surface(std::span<const BeamPoint> points, const Eigen::Vector3d& T_robot_sensor,
                  std::vector<SurfacePoint>& surface) {
  const double c = std::cos(T_robot_sensor[2]), s = std::sin(T_robot_sensor[2]);
  Eigen::Matrix2d R_robot_sensor;
  R_robot_sensor << c, -s, s, c;
  surface.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    SurfacePoint& point = surface[i];
    point.smooth = false;
    point.p = T_robot_sensor.head<2>() + R_robot_sensor * points[i].p;
    point.bearing = points[i].bearing + T_robot_sensor[2];
    const std::size_t first = reach(points, i, -1), last = reach(points, i, 1);
    fit_line(points.subspan(first, last - first + 1), point);
    if (!point.smooth) continue;
    point.n = R_robot_sensor * point.n;
    point.foot = T_robot_sensor.head<2>() + R_robot_sensor * point.foot;
  }
}

}  // namespace libslam
