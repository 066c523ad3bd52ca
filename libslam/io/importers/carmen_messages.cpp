#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <libslam/io/importers/carmen_messages.hpp>

namespace libslam {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kDegree = kPi / 180.0;
constexpr std::int64_t kMostBeams = 10000;

Eigen::Vector3d pose_in(const TextReader& row, std::size_t column) {
  return {row.number(column), row.number(column + 1), row.number(column + 2)};
}

/// Pose of `to` in the frame of `from`.
Eigen::Vector3d relative(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Eigen::Vector3d pose;
  pose.head<2>() = Eigen::Rotation2Dd(-from.z()) * (to - from).head<2>();
  pose.z() = std::remainder(to.z() - from.z(), 2.0 * kPi);
  return pose;
}

std::size_t count_in(const TextReader& row, std::size_t column, std::int64_t least) {
  const std::int64_t count = row.integer(column);
  if (count < least || count > kMostBeams)
    row.reject(std::to_string(count) + " values, expected " + std::to_string(least) + " to " +
               std::to_string(kMostBeams));
  return static_cast<std::size_t>(count);
}

void read_ranges(const TextReader& row, std::size_t first, std::size_t count,
                 CarmenMessage& message) {
  message.ranges.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    message.ranges.push_back(static_cast<float>(row.number(first + i)));
}

double front_laser_resolution(const TextReader& row, std::size_t beams) {
  for (const std::size_t per_degree : {1U, 2U, 4U})
    if (beams == 180 * per_degree || beams == 180 * per_degree + 1)
      return kDegree / static_cast<double>(per_degree);
  row.reject("FLASER with " + std::to_string(beams) +
             " beams; their spacing is known for 180, 181, 360, 361, 720 and 721");
}

CarmenMessage read_front_laser(const TextReader& row, double max_range) {
  CarmenMessage message;
  const std::size_t beams = count_in(row, 1, 1), after = 2 + beams;
  message.laser.first_bearing = -0.5 * kPi;
  message.laser.resolution = front_laser_resolution(row, beams);
  message.laser.max_range = max_range;
  read_ranges(row, 2, beams, message);
  message.robot = pose_in(row, after + 3);
  message.laser.T_robot_sensor = relative(message.robot, pose_in(row, after));
  message.time = row.number(after + 6);
  return message;
}

CarmenMessage read_robot_laser(const TextReader& row, double max_range) {
  CarmenMessage message;
  LaserGeometry& laser = message.laser;
  laser.first_bearing = row.number(2);
  laser.resolution = row.number(4);
  laser.max_range = std::min(max_range, row.number(5));
  laser.sigma_range = row.number(6);
  if (!(laser.resolution > 0.0 && laser.max_range > 0.0 && laser.sigma_range >= 0.0))
    row.reject("resolution and maximum range of the laser must be positive");
  const std::size_t beams = count_in(row, 8, 1), remissions = count_in(row, 9 + beams, 0);
  if (laser.resolution * static_cast<double>(beams - 1) > 2.0 * kPi)
    row.reject("the beams of the laser go more than once around");
  read_ranges(row, 9, beams, message);
  const std::size_t after = 10 + beams + remissions;
  message.robot = pose_in(row, after + 3);
  laser.T_robot_sensor = relative(message.robot, pose_in(row, after));
  message.time = row.number(after + 11);
  return message;
}

CarmenMessage read_odometry(const TextReader& row) {
  CarmenMessage message;
  message.robot = pose_in(row, 1);
  message.time = row.number(7);
  return message;
}

}  // namespace

std::optional<CarmenMessage> read_carmen_message(const TextReader& row, double max_range) {
  std::optional<CarmenMessage> message;
  if (row.word(0) == "FLASER")
    message = read_front_laser(row, max_range);
  else if (row.word(0) == "ROBOTLASER1")
    message = read_robot_laser(row, max_range);
  else if (row.word(0) == "ODOM")
    message = read_odometry(row);
  if (!message) return message;
  message->line = row.line();
  if (message->time < 0.0) row.reject("the time stamp is negative");
  return message;
}

}  // namespace libslam
