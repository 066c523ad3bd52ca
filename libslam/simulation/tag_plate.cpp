#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <limits>
#include <memory>

#include <libslam/data/tag_points.hpp>
#include <libslam/simulation/tag_plate.hpp>

namespace libslam {

namespace {

/// A wall farther than this behind a landmark does not carry it [m].
constexpr double kFarthestWall = 1e3;

}  // namespace

TagPlate make_plate(std::int64_t tag, const Eigen::Vector3d& p, double size,
                    const RayCaster& walls) {
  TagPlate plate{tag, p, Eigen::Vector2d::UnitX(), size};
  const double distance = p.head<2>().norm();
  if (distance > 0.0) plate.normal = -p.head<2>() / distance;
  if (walls.empty()) return plate;
  double nearest = kFarthestWall;
  for (const Eigen::Vector2d& away : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1),
                                      Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, -1)}) {
    const double range = walls.cast(p.head<2>(), away, kFarthestWall);
    if (range >= nearest) continue;
    nearest = range;
    plate.normal = -away;
  }
  return plate;
}

std::vector<TrueLandmark> tag_corners(const World& world, double size) {
  const RayCaster walls(world.walls, {});
  std::vector<TrueLandmark> corners;
  for (const TrueLandmark& landmark : world.landmarks) {
    if (landmark.id < 0 || landmark.id >= kTags) continue;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    centre.head(landmark.position.size()) = landmark.position;
    const TagPlate plate = make_plate(landmark.id, centre, size, walls);
    const Eigen::Vector3d right(0.5 * size * plate.right().x(), 0.5 * size * plate.right().y(), 0);
    const Eigen::Vector3d up(0.0, 0.0, 0.5 * size);
    corners.push_back({tag_point_id(landmark.id, 1), centre - right + up});
    corners.push_back({tag_point_id(landmark.id, 2), centre + right + up});
    corners.push_back({tag_point_id(landmark.id, 3), centre + right - up});
    corners.push_back({tag_point_id(landmark.id, 4), centre - right - up});
  }
  return corners;
}

std::array<bool, 100> tag_bits(std::int64_t tag) {
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(tag36h11_create(),
                                                                                tag36h11_destroy);
  const std::unique_ptr<image_u8_t, void (*)(image_u8_t*)> image(
      apriltag_to_image(family.get(), static_cast<std::uint32_t>(tag)), image_u8_destroy);
  std::array<bool, 100> bits{};
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x)
      bits[static_cast<std::size_t>(10 * y + x)] = image->buf[y * image->stride + x] > 127;
  return bits;
}

}  // namespace libslam
