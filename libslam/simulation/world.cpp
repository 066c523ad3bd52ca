#include <cmath>
#include <random>

#include <libslam/simulation/random_stream.hpp>
#include <libslam/simulation/world.hpp>

namespace libslam {

namespace {

// Part of the half-extent at which way-points of a random world lie.
constexpr double kInnerRing = 0.5, kOuterRing = 0.9;

using Uniform = std::uniform_real_distribution<double>;

RandomStream stream_of(const WorldParameters& parameters, std::uint64_t what) {
  return {static_cast<std::uint64_t>(parameters.seed), RandomPurpose::kWorld, what};
}

/// A landmark with a height, where the world has any.
TrueLandmark make_landmark(const WorldParameters& parameters, int id, const Eigen::Vector2d& p,
                           RandomStream& random) {
  if (!(parameters.max_height > 0.0)) return {id, p};
  return {id, Eigen::Vector3d(p.x(), p.y(), Uniform(0.0, parameters.max_height)(random))};
}

/// Start at the first way-point, looking at the second.
void start_on_lap(World& world) {
  const Eigen::Vector2d& first = world.way_points.front();
  const Eigen::Vector2d ahead =
      world.way_points.size() > 1 ? world.way_points[1] - first : Eigen::Vector2d(1.0, 0.0);
  world.T_world_start = {first.x(), first.y(), std::atan2(ahead.y(), ahead.x())};
}

/// The grid of rooms; room (0, 0) has its lower left corner at the origin.
class Floor {
 public:
  explicit Floor(const WorldParameters& p)
      : columns_(p.rooms_x),
        rows_(p.rooms_y),
        size_(p.room_size_x, p.room_size_y),
        door_(p.door_width) {}

  Eigen::Vector2d centre(int column, int row) const {
    return size_.cwiseProduct(Eigen::Vector2d(column + 0.5, row + 0.5));
  }

  /// Outer walls whole, inner ones with a door in the middle of every room's side.
  std::vector<Wall> walls() const {
    std::vector<Wall> walls;
    for (int line = 0; line <= columns_; ++line)
      for (int row = 0; row < rows_; ++row)
        add_side(walls, {line * size_.x(), row * size_.y()}, {0.0, size_.y()},
                 line > 0 && line < columns_);
    for (int line = 0; line <= rows_; ++line)
      for (int column = 0; column < columns_; ++column)
        add_side(walls, {column * size_.x(), line * size_.y()}, {size_.x(), 0.0},
                 line > 0 && line < rows_);
    return walls;
  }

  /// Centres of the rooms row by row, there and back: neighbours are joined by a door.
  std::vector<Eigen::Vector2d> lap() const {
    std::vector<Eigen::Vector2d> way;
    for (int row = 0; row < rows_; ++row)
      for (int i = 0; i < columns_; ++i)
        way.push_back(centre(row % 2 == 0 ? i : columns_ - 1 - i, row));
    for (std::size_t i = way.size(); i-- > 1;) way.push_back(way[i - 1]);
    return way;
  }

  /// A place on a wall of a random room, away from its door.
  Eigen::Vector2d place_at_wall(RandomStream& random) const {
    const int column = std::uniform_int_distribution<int>(0, columns_ - 1)(random);
    const int row = std::uniform_int_distribution<int>(0, rows_ - 1)(random);
    const int side = std::uniform_int_distribution<int>(0, 3)(random);
    const int along = side % 2, across = 1 - along;
    const double free = (size_[along] - door_) / 2;
    double s = Uniform(0.0, 2.0 * free)(random);
    if (s > free) s += door_;
    Eigen::Vector2d p;
    p[along] = s;
    p[across] = side < 2 ? kStandOff : size_[across] - kStandOff;
    return p + size_.cwiseProduct(Eigen::Vector2d(column, row));
  }

 private:
  static constexpr double kStandOff = 0.05;  ///< of landmarks from their wall [m]

  void add_side(std::vector<Wall>& walls, const Eigen::Vector2d& from, const Eigen::Vector2d& side,
                bool with_door) const {
    const Eigen::Vector2d to = from + side;
    if (!with_door) {
      walls.push_back({from, to});
      return;
    }
    const Eigen::Vector2d jamb = side * (0.5 - door_ / (2.0 * side.norm()));
    walls.push_back({from, from + jamb});
    walls.push_back({to - jamb, to});
  }

  int columns_, rows_;
  Eigen::Vector2d size_;
  double door_;
};

}  // namespace

World make_random_world(const WorldParameters& parameters) {
  World world;
  const Eigen::Vector2d size(parameters.size_x, parameters.size_y);
  RandomStream places = stream_of(parameters, 0);
  for (int i = 0; i < parameters.landmarks; ++i) {
    const double x = Uniform(-0.5, 0.5)(places), y = Uniform(-0.5, 0.5)(places);
    world.landmarks.push_back(
        make_landmark(parameters, i + 1, size.cwiseProduct(Eigen::Vector2d(x, y)), places));
  }
  RandomStream lap = stream_of(parameters, 1);
  for (int i = 0; i < parameters.way_points; ++i) {
    const double angle = 2.0 * kPi * i / parameters.way_points;
    const double ring = Uniform(kInnerRing, kOuterRing)(lap);
    world.way_points.push_back(
        0.5 * ring * size.cwiseProduct(Eigen::Vector2d(std::cos(angle), std::sin(angle))));
  }
  start_on_lap(world);
  return world;
}

World make_rooms(const WorldParameters& parameters) {
  World world;
  const Floor floor(parameters);
  world.walls = floor.walls();
  world.way_points = floor.lap();
  RandomStream places = stream_of(parameters, 0);
  for (int i = 0; i < parameters.landmarks; ++i)
    world.landmarks.push_back(
        make_landmark(parameters, i + 1, floor.place_at_wall(places), places));
  start_on_lap(world);
  return world;
}

}  // namespace libslam
