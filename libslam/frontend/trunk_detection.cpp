#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <libslam/frontend/trunk_detection.hpp>

namespace libslam {

namespace {

constexpr double kRadiansPerDegree = 3.141592653589793 / 180.0;

/// Where beam i hit, in the frame of the laser.
Eigen::Vector2d point(const BeamView& scan, std::size_t i) {
  const double bearing = scan.first_bearing + scan.resolution * static_cast<double>(i);
  return scan.ranges[i] * Eigen::Vector2d(std::cos(bearing), std::sin(bearing));
}

double square(double x) {
  return x * x;
}

/// Distance of the centre of a circle from beams on it, weighted by the square of the cosine of
/// their incidence w: past the edge of a real trunk a beam is half on what is behind.
class CentreFit {
 public:
  explicit CentreFit(double radius = 0.0) : radius_(radius) {}

  /// A beam of that range, beside the middle by that angle [rad].
  void add(double range, double beside) {
    constexpr double kGrazing = 0.01;  // of a beam that passes the circle
    const double across = range * std::sin(beside);
    const double incidence =
        std::sqrt(std::max(kGrazing, 1.0 - square(across / std::max(radius_, 1e-9))));
    const double weight = square(incidence);
    sum_ += weight * (range * std::cos(beside) + radius_ * incidence);
    weights_ += weight;
    squares_ += square(weight);
    slopes_ += weight / incidence;
  }

  double range() const { return sum_ / weights_; }
  /// Variance of the range over that of one beam.
  double noise_factor() const { return squares_ / square(weights_); }
  /// Derivative of the range by the radius.
  double per_radius() const { return slopes_ / weights_; }

 private:
  double radius_, sum_ = 0.0, weights_ = 0.0, squares_ = 0.0, slopes_ = 0.0;
};

}  // namespace

TrunkDetector::TrunkDetector(const TrunkParameters& parameters) : parameters_(parameters) {
  if (!(parameters.jump > 0.0 && parameters.min_beams > 0 && parameters.sigma_range > 0.0))
    throw std::invalid_argument(
        "frontend.trunks: jump, min_beams and sigma_range must be positive");
  if (!(parameters.min_diameter < parameters.max_diameter))
    throw std::invalid_argument("frontend.trunks: min_diameter must be below max_diameter");
}

void TrunkDetector::segment(const BeamView& scan) {
  const double gap = parameters_.gap_deg * kRadiansPerDegree + 1e-9;
  objects_.clear();
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    if (!std::isfinite(scan.ranges[i])) continue;
    if (!objects_.empty()) {
      Object& object = objects_.back();
      const std::size_t step = i - object.last;
      const bool near = step == 1 || scan.resolution * static_cast<double>(step) <= gap;
      if (near && std::abs(scan.ranges[i] - scan.ranges[object.last]) <= parameters_.jump) {
        object.last = i;
        continue;
      }
    }
    objects_.push_back({i, i});
  }
}

bool TrunkDetector::stands_free(const BeamView& scan, const Object& object) const {
  const double margin = parameters_.margin_deg * kRadiansPerDegree - 1e-9;
  const auto [first, last] = object;
  const std::size_t after = scan.ranges.size() - 1 - last;
  if (first == 0 || after == 0 || scan.resolution * static_cast<double>(first) < margin ||
      scan.resolution * static_cast<double>(after) < margin)
    return false;
  return scan.ranges[first - 1] > scan.ranges[first] && scan.ranges[last + 1] > scan.ranges[last];
}

bool TrunkDetector::is_isolated(const BeamView& scan, std::size_t index) const {
  const auto far = [&](std::size_t i, std::size_t j) {
    return (point(scan, i) - point(scan, j)).norm() >= parameters_.isolation;
  };
  const Object& object = objects_[index];
  return (index == 0 || far(objects_[index - 1].last, object.first)) &&
         (index + 1 == objects_.size() || far(object.last, objects_[index + 1].first));
}

DetectedTrunk TrunkDetector::fit(const BeamView& scan, const Object& object) const {
  constexpr int kIterations = 4;  // each gains a digit or more: the angle is small
  const auto [first, last] = object;
  DetectedTrunk trunk;
  trunk.first_beam = first;
  trunk.beams = last - first + 1;
  const double middle = 0.5 * static_cast<double>(first + last);
  const double half_width = std::min(0.5 * scan.resolution * static_cast<double>(trunk.beams), 1.5);
  trunk.bearing = scan.first_bearing + scan.resolution * middle;
  trunk.range = scan.ranges[first];
  const double known = 0.5 * parameters_.known_diameter;
  CentreFit centre;
  for (int k = 0; k < kIterations; ++k) {
    centre = CentreFit(known > 0.0 ? known : trunk.range * std::sin(half_width));
    for (std::size_t i = first; i <= last; ++i)
      if (std::isfinite(scan.ranges[i]))
        centre.add(scan.ranges[i], scan.resolution * (static_cast<double>(i) - middle));
    trunk.range = centre.range();
  }
  trunk.diameter = 2.0 * trunk.range * std::sin(half_width);
  const double var_edges = square(scan.resolution) / 24.0;
  const double var_centre = square(parameters_.sigma_centre);
  const double var_radius = known > 0.0 ? 0.0 : square(trunk.range) * var_edges;
  trunk.cov(0, 0) = square(parameters_.sigma_range) * centre.noise_factor() +
                    square(centre.per_radius()) * var_radius + var_centre;
  trunk.cov(1, 1) = var_edges + var_centre / square(trunk.range);
  return trunk;
}

bool TrunkDetector::has_shape(const BeamView& scan, const DetectedTrunk& trunk) const {
  const double edges =
      scan.ranges[trunk.first_beam + trunk.beams - 1] - scan.ranges[trunk.first_beam];
  return trunk.diameter >= parameters_.min_diameter && trunk.diameter <= parameters_.max_diameter &&
         std::abs(edges) <= parameters_.skew * trunk.diameter;
}

void TrunkDetector::detect(const BeamView& scan, std::vector<DetectedTrunk>& trunks) {
  trunks.clear();
  segment(scan);
  for (std::size_t index = 0; index < objects_.size(); ++index) {
    const Object& object = objects_[index];
    if (object.last - object.first + 1 < static_cast<std::size_t>(parameters_.min_beams) ||
        !stands_free(scan, object) || !is_isolated(scan, index))
      continue;
    if (const DetectedTrunk trunk = fit(scan, object); has_shape(scan, trunk))
      trunks.push_back(trunk);
  }
}

}  // namespace libslam
