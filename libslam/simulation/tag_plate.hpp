#pragma once
// Square plates with tags at the landmarks of a world.

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <libslam/simulation/ray_caster.hpp>
#include <libslam/simulation/world.hpp>

namespace libslam {

/// Tags of the family tag36h11: 0 to 586.
inline constexpr std::int64_t kTags = 587;

/// An upright plate. Up is the z axis of the world.
struct TagPlate {
  std::int64_t tag = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< world [m]
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< out of its front, world
  double size = 0.0;                                  ///< side of the black border [m]

  /// To the right as seen by who looks at the front.
  Eigen::Vector2d right() const { return {-normal.y(), normal.x()}; }
};

/// The plate of a landmark at `p`: its back to the nearest wall along an axis of the world; without
/// walls its front to the origin.
TagPlate make_plate(std::int64_t tag, const Eigen::Vector3d& p, double size,
                    const RayCaster& walls);

/// The corners of all tags with their identities (data/tag_points.hpp); the centres are the
/// landmarks themselves.
std::vector<TrueLandmark> tag_corners(const World& world, double size);

/// Bits of a tag, row by row from the top left, 10 x 10 with the white margin; the black border is
/// the square of 8 x 8. True is white.
std::array<bool, 100> tag_bits(std::int64_t tag);

}  // namespace libslam
