#pragma once
// Gray images of a textured indoor scene, by casting rays.
//
// The camera looks along the horizon, so that all rays of a column lie in one upright plane: it
// meets walls and plates at one depth, and only floor and ceiling change along it.

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Core>

#include <libslam/simulation/ray_caster.hpp>
#include <libslam/simulation/tag_plate.hpp>

namespace libslam {

/// A pinhole camera at `height` above the floor; pixel (0, 0) is the middle of the first pixel.
struct RenderedCamera {
  Eigen::Vector3d T_world_camera = Eigen::Vector3d::Zero();  ///< x [m], y [m], direction [rad]
  double height = 0.0;                                       ///< [m]
  double focal_length = 0.0, cx = 0.0, cy = 0.0;             ///< [px]
  int columns = 0, rows = 0;
};

class SceneRenderer {
 public:
  /// `ceiling`: height of walls and ceiling [m].
  explicit SceneRenderer(double ceiling) : ceiling_(ceiling) {}

  /// Gray values from 0 to 255, row by row. Floor, walls and ceiling carry random blocks that stay
  /// where they are (a texture in space), and fade where they would be smaller than a pixel.
  std::vector<float> render(const RenderedCamera& camera, const RayCaster& walls,
                            const std::vector<TagPlate>& plates);

 private:
  struct Crossing {
    double depth;   ///< along the axis of the camera [m]
    double across;  ///< on the plate from its centre, to the right [m]
    const TagPlate* plate;
    bool front;
  };
  /// Prepares a column; returns the depth of the wall [m].
  double enter_column(const RenderedCamera& camera, double u, const RayCaster& walls,
                      const std::vector<TagPlate>& plates);
  float shade(const RenderedCamera& camera, double v, double wall) const;

  double ceiling_;
  Eigen::Vector2d direction_ = Eigen::Vector2d::UnitX();  ///< of the column, per depth
  std::vector<Crossing> crossings_;                       ///< of the column, near ones first
  std::map<std::int64_t, std::array<bool, 100>> bits_;    ///< of the tags seen so far
};

}  // namespace libslam
