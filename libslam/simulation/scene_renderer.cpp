#include <algorithm>
#include <cmath>
#include <limits>

#include <libslam/simulation/scene_renderer.hpp>

namespace libslam {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Samples per pixel and axis.
constexpr int kSamples = 2;
constexpr double kFarthest = 1e3;  ///< [m]
constexpr float kSky = 200.0F, kBack = 90.0F, kBlack = 25.0F, kWhite = 230.0F, kMean = 128.0F;
/// Side [m] and amplitude of the blocks of the texture.
constexpr std::array<std::array<double, 2>, 3> kBlocks = {
    {{0.61, 45.0}, {0.23, 35.0}, {0.09, 25.0}}};
/// Blocks begin here, so that walls at round coordinates do not run along their sides [cells].
constexpr double kShift = 0.381966;
/// The tag is 8 of the 10 cells of its plate.
constexpr double kCells = 10.0, kBorderCells = 8.0;

/// A number in [-1, 1) that belongs to a cell (finalizer of MurmurHash3).
double cell_value(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t level) {
  auto h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL ^
           static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL ^
           static_cast<std::uint64_t>(z) * 0x165667B19E3779F9ULL ^ (level + 1) << 56;
  h = (h ^ (h >> 33)) * 0xFF51AFD7ED558CCDULL;
  h = (h ^ (h >> 33)) * 0xC4CEB9FE1A85EC53ULL;
  return static_cast<double>(h >> 11) * 0x1p-52 - 1.0;
}

/// `footprint`: size of a pixel there [m].
float texture(const Eigen::Vector3d& p, double footprint) {
  double value = kMean;
  for (std::size_t level = 0; level < kBlocks.size(); ++level) {
    const auto [side, amplitude] = kBlocks[level];
    const double fade = std::clamp(0.5 * side / footprint - 0.5, 0.0, 1.0);
    if (fade == 0.0) continue;
    const Eigen::Vector3d cell = (p / side).array() + kShift;
    value +=
        fade * amplitude *
        cell_value(std::llround(cell.x()), std::llround(cell.y()), std::llround(cell.z()), level);
  }
  return static_cast<float>(value);
}

}  // namespace

std::vector<float> SceneRenderer::render(const RenderedCamera& camera, const RayCaster& walls,
                                         const std::vector<TagPlate>& plates) {
  for (const TagPlate& plate : plates)
    if (!bits_.contains(plate.tag)) bits_[plate.tag] = tag_bits(plate.tag);
  std::vector<float> image(static_cast<std::size_t>(camera.columns * camera.rows), 0.0F);
  constexpr float kShare = 1.0F / (kSamples * kSamples);
  for (int column = 0; column < camera.columns * kSamples; ++column) {
    const double u = (column + 0.5) / kSamples - 0.5;
    const double wall = enter_column(camera, u, walls, plates);
    for (int row = 0; row < camera.rows * kSamples; ++row) {
      const auto at = static_cast<std::size_t>(row / kSamples * camera.columns + column / kSamples);
      image[at] += kShare * shade(camera, (row + 0.5) / kSamples - 0.5, wall);
    }
  }
  return image;
}

double SceneRenderer::enter_column(const RenderedCamera& camera, double u, const RayCaster& walls,
                                   const std::vector<TagPlate>& plates) {
  const double c = std::cos(camera.T_world_camera.z()), s = std::sin(camera.T_world_camera.z());
  const double left = (camera.cx - u) / camera.focal_length;
  direction_ = {c - s * left, s + c * left};
  const Eigen::Vector2d origin = camera.T_world_camera.head<2>();
  const double stretch = direction_.norm();
  const double range =
      walls.empty() ? kInfinity : walls.cast(origin, direction_ / stretch, kFarthest);
  crossings_.clear();
  for (const TagPlate& plate : plates) {
    const Eigen::Vector2d to_plate = plate.centre.head<2>() - origin;
    const double approach = direction_.dot(plate.normal);
    if (approach == 0.0) continue;
    const double depth = to_plate.dot(plate.normal) / approach;
    if (!(depth > 0.0) || depth * stretch > range) continue;
    const double across = (depth * direction_ - to_plate).dot(plate.right());
    if (std::abs(across) <= 0.5 * plate.size * kCells / kBorderCells)
      crossings_.push_back({depth, across, &plate, approach < 0.0});
  }
  std::sort(crossings_.begin(), crossings_.end(),
            [](const Crossing& a, const Crossing& b) { return a.depth < b.depth; });
  return range < kFarthest ? range / stretch : kInfinity;
}

float SceneRenderer::shade(const RenderedCamera& camera, double v, double wall) const {
  const double fall = (v - camera.cy) / camera.focal_length;  // per depth
  double depth = wall;
  if (fall > 0.0) depth = std::min(depth, camera.height / fall);
  if (fall < 0.0 && wall < kInfinity) depth = std::min(depth, (camera.height - ceiling_) / fall);
  for (const Crossing& crossing : crossings_) {
    if (crossing.depth > depth) break;
    const TagPlate& plate = *crossing.plate;
    const double cell = plate.size / kBorderCells;
    const double down = plate.centre.z() - (camera.height - fall * crossing.depth);
    if (std::abs(down) > 0.5 * kCells * cell) continue;
    if (!crossing.front) return kBack;
    const int x = std::clamp(static_cast<int>(crossing.across / cell + 0.5 * kCells), 0, 9);
    const int y = std::clamp(static_cast<int>(down / cell + 0.5 * kCells), 0, 9);
    return bits_.at(plate.tag)[static_cast<std::size_t>(10 * y + x)] ? kWhite : kBlack;
  }
  if (depth >= kInfinity) return kSky;
  Eigen::Vector3d p;
  p << camera.T_world_camera.head<2>() + depth * direction_, camera.height - fall * depth;
  return texture(p, depth / camera.focal_length);
}

}  // namespace libslam
