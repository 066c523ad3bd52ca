#include <algorithm>
#include <cmath>
#include <tuple>

#include <libslam/frontend/line_extraction.hpp>

namespace libslam {

namespace {

/// Noise may widen the distance of two neighbours on one surface by so many sigma.
constexpr double kJumpSigmas = 3.0;
/// No point of a wall is farther off than so many sigma of its range across the wall, and of the
/// wall itself (floor_r).
constexpr double kRangeSigmas = 4.0, kWallSigmas = 2.0;
/// Beams that meet a wall at a smaller sine say little of where they meet it.
constexpr double kGrazing = 0.05;
/// A chord through two points fits anything.
constexpr std::size_t kFewestPoints = 3;
/// Lines that meet at a smaller angle [rad] have no corner that noise would not move by far.
constexpr double kSharpestCorner = 0.3;

Eigen::Vector2d left_of(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

}  // namespace

LineExtraction::LineExtraction(const ScanLinesParameters& parameters) : parameters_(parameters) {}

LineExtraction::Sums LineExtraction::Sums::operator-(const Sums& o) const {
  return {n - o.n, x - o.x, y - o.y, xx - o.xx, xy - o.xy, yy - o.yy};
}

LineExtraction::Sums LineExtraction::Sums::operator+(const Sums& o) const {
  return {n + o.n, x + o.x, y + o.y, xx + o.xx, xy + o.xy, yy + o.yy};
}

std::span<const ExtractedLine> LineExtraction::extract(std::span<const BeamPoint> points,
                                                       double step) {
  points_ = points;
  step_ = step;
  lines_.clear();
  runs_.clear();
  sums_.resize(points.size() + 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d& p = points[i].p;
    sums_[i + 1] = sums_[i] + Sums{1.0, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y()};
  }
  for (std::size_t first = 0; first < points.size();) {
    std::size_t last = first + 1;
    while (last < points.size() && !breaks(points[last - 1], points[last])) ++last;
    split(first, last);
    first = last;
  }
  for (std::size_t i = 1; i < runs_.size(); ++i) part_at_corner(runs_[i - 1], runs_[i]);
  merge_across_gaps();
  for (std::size_t i = 0; i < merged_.size(); ++i) {
    const Line& line = merged_[i];
    if (line.alive && line.sums.n >= parameters_.min_points &&
        line.extent.length() >= parameters_.min_length)
      lines_.push_back(finish(i));
  }
  std::ranges::sort(lines_, [](const ExtractedLine& a, const ExtractedLine& b) {
    return std::tuple(b.extent.length(), a.alpha) < std::tuple(a.extent.length(), b.alpha);
  });
  return lines_;
}

// On a surface at the angle lambda against the beam, the law of sines gives the distance.
bool LineExtraction::breaks(const BeamPoint& before, const BeamPoint& after) const {
  const double lambda = parameters_.break_angle_deg * kPi / 180.0;
  const double turn = after.bearing - before.bearing;
  if (turn >= lambda) return true;
  const double jump = (after.p - before.p).norm() - kJumpSigmas * parameters_.sigma_range;
  return jump > std::min(before.range, after.range) * std::sin(turn) / std::sin(lambda - turn);
}

LineExtraction::Fit LineExtraction::fit(const Sums& s) {
  Fit fit;
  fit.centre = Eigen::Vector2d(s.x, s.y) / s.n;
  const double xx = s.xx - s.n * fit.centre.x() * fit.centre.x();
  const double xy = s.xy - s.n * fit.centre.x() * fit.centre.y();
  const double yy = s.yy - s.n * fit.centre.y() * fit.centre.y();
  fit.alpha = 0.5 * std::atan2(-2.0 * xy, yy - xx);
  fit.n = {std::cos(fit.alpha), std::sin(fit.alpha)};
  fit.r = fit.n.dot(fit.centre);
  if (fit.r < 0.0) {
    fit.r = -fit.r;
    fit.n = -fit.n;
    fit.alpha += fit.alpha > 0.0 ? -kPi : kPi;
  }
  return fit;
}

/// Along a grazing beam noise moves a point along the wall, hardly off it.
double LineExtraction::bound(const Eigen::Vector2d& n, const BeamPoint& point) const {
  const double facing = std::abs(n.dot(point.p)) / point.range;
  return std::min(parameters_.split_distance, kWallSigmas * parameters_.floor_r +
                                                  kRangeSigmas * parameters_.sigma_range * facing);
}

bool LineExtraction::fits(const Fit& fit, std::size_t first, std::size_t last) const {
  for (std::size_t i = first; i < last; ++i)
    if (std::abs(fit.n.dot(points_[i].p) - fit.r) > bound(fit.n, points_[i])) return false;
  return true;
}

bool LineExtraction::fits(const Fit& fit, std::size_t line) const {
  return std::ranges::all_of(
      runs_, [&](const Run& run) { return run.line != line || fits(fit, run.first, run.last); });
}

void LineExtraction::split(std::size_t first, std::size_t last) {
  ends_.assign(1, last);
  while (!ends_.empty()) {
    const std::size_t corner = farthest_from_chord(first, ends_.back());
    if (corner != first) {
      ends_.push_back(corner + 1);  // the corner belongs to both sides
      continue;
    }
    add_run(first, ends_.back());
    first = ends_.back() - 1;
    ends_.pop_back();
  }
}

/// `first` if no point is farther from the chord than it may be.
std::size_t LineExtraction::farthest_from_chord(std::size_t first, std::size_t last) const {
  std::size_t farthest = first;
  double most = 1.0;
  const Eigen::Vector2d& from = points_[first].p;
  const Eigen::Vector2d across = left_of((points_[last - 1].p - from).normalized());
  for (std::size_t i = first + 1; i + 1 < last; ++i) {
    const double distance = std::abs(across.dot(points_[i].p - from)) / bound(across, points_[i]);
    if (distance <= most) continue;
    most = distance;
    farthest = i;
  }
  return farthest;
}

void LineExtraction::add_run(std::size_t first, std::size_t last) {
  if (last - first < kFewestPoints) return;
  if (!runs_.empty() && runs_.back().last == first + 1) {  // a noisy corner split one line
    Run& before = runs_.back();
    const Sums sums = sums_[last] - sums_[before.first];
    if (fits(fit(sums), before.first, last)) {
      before.last = last;
      before.sums = sums;
      return;
    }
  }
  runs_.push_back({first, last, sums_[last] - sums_[first], runs_.size()});
}

/// A split leaves points of the other wall, up to split_distance off, at the end of a run; they
/// would turn its line always the same way. The bearing of where both lines meet is known better.
void LineExtraction::part_at_corner(Run& before, Run& after) const {
  if (after.first + 1 != before.last) return;
  for (int pass = 0; pass < 2; ++pass) {
    const Fit a = fit(before.sums), b = fit(after.sums);
    const double cross = a.n.x() * b.n.y() - a.n.y() * b.n.x();
    if (std::abs(cross) < std::sin(kSharpestCorner)) return;
    const Eigen::Vector2d corner(a.r * b.n.y() - b.r * a.n.y(), b.r * a.n.x() - a.r * b.n.x());
    const double bearing = std::atan2(corner.y() / cross, corner.x() / cross);
    std::size_t first = before.first + kFewestPoints;
    const std::size_t end = after.last - kFewestPoints;
    while (first < end && points_[first].bearing < bearing) ++first;
    const bool moved_fit = fits(a, std::min(before.last, first), first) &&
                           fits(b, first, std::max(after.first, first));
    if (!moved_fit) return;  // no corner of two walls
    before = {before.first, first, sums_[first] - sums_[before.first], before.line};
    after = {first, after.last, sums_[after.last] - sums_[first], after.line};
  }
}

double LineExtraction::spacing(const BeamPoint& point, const Fit& fit) const {
  const double facing = std::max(std::abs(fit.n.dot(point.p)) / point.range, 1e-3);
  return point.range * step_ / facing;
}

/// The ends are those of the first and the last point; the surface ends somewhere before the next.
void LineExtraction::include(Line& line, const Run& run) const {
  static const double kUniform = 1.0 / std::sqrt(12.0);
  const Eigen::Vector2d along = left_of(line.fit.n);
  for (const BeamPoint* point : {&points_[run.first], &points_[run.last - 1]}) {
    const double place = along.dot(point->p), sigma = kUniform * spacing(*point, line.fit);
    if (line.extent.sigma_begin == 0.0)
      line.extent = {place, place, sigma, sigma};
    else
      line.extent.include({place, place, sigma, sigma});
  }
}

void LineExtraction::merge_across_gaps() {
  merged_.clear();
  for (const Run& run : runs_)
    include(merged_.emplace_back(Line{run.sums, fit(run.sums), {}, true}), run);
  for (std::size_t i = 0; i < merged_.size(); ++i)
    for (std::size_t k = 0; k < merged_.size(); ++k)
      if (i != k && merged_[i].alive && merged_[k].alive && merge(i, k)) k = 0;
}

bool LineExtraction::merge(std::size_t into, std::size_t other) {
  const Sums sums = merged_[into].sums + merged_[other].sums;
  Line joint{sums, fit(sums), {}, true};
  if (!fits(joint.fit, into) || !fits(joint.fit, other)) return false;
  if (merged_[into].extent.gap_to(merged_[other].extent) > parameters_.merge_gap) return false;
  for (Run& run : runs_) {
    if (run.line == other) run.line = into;
    if (run.line == into) include(joint, run);
  }
  merged_[into] = joint;
  merged_[other].alive = false;
  return true;
}

/// A range that is too long moves a point off the wall and along it at once: the farther end of a
/// short segment would always tilt outwards. Regression on where the beams meet the wall does not
/// see that (an instrumental variable).
LineExtraction::Fit LineExtraction::without_tilt(std::size_t index) const {
  Fit fit = merged_[index].fit;
  const Eigen::Vector2d along = left_of(fit.n);
  double all_met = 0.0, all_places = 0.0, with_place = 0.0, with_error = 0.0;
  for (const Run& run : runs_) {
    if (run.line != index) continue;
    for (std::size_t i = run.first; i < run.last; ++i) {
      const BeamPoint& point = points_[i];
      const double facing = fit.n.dot(point.p), place = along.dot(point.p);
      if (facing < kGrazing * point.range) return fit;
      const double met = fit.r * place / facing;
      all_met += met;
      all_places += place;
      with_place += met * place;
      with_error += met * (facing - fit.r);
    }
  }
  const double slope = with_error / (with_place - all_met * all_places / merged_[index].sums.n);
  fit.alpha = std::remainder(fit.alpha - slope, 2.0 * kPi);
  fit.n = {std::cos(fit.alpha), std::sin(fit.alpha)};
  fit.r = fit.n.dot(fit.centre);
  return fit;
}

ExtractedLine LineExtraction::finish(std::size_t index) const {
  const Line& line = merged_[index];
  const Fit fit = without_tilt(index);
  const Eigen::Vector2d along = left_of(fit.n);
  double ss = 0.0, alpha = 0.0, r = 0.0, both = 0.0;
  for (const Run& run : runs_) {
    if (run.line != index) continue;
    for (std::size_t i = run.first; i < run.last; ++i) {
      const double s = along.dot(points_[i].p - fit.centre);
      const double facing = fit.n.dot(points_[i].p) / points_[i].range;
      const double noise = facing * facing;
      ss += s * s;
      alpha += s * s * noise;
      both -= s * noise;
      r += noise;
    }
  }
  const double variance = parameters_.sigma_range * parameters_.sigma_range;
  const double n = line.sums.n, length = line.extent.length();
  const double widening = parameters_.floor_length / length;
  const double floor = parameters_.floor_alpha_deg * kPi / 180.0;
  Eigen::Matrix2d at_centre;
  at_centre(0, 0) = variance * alpha / (ss * ss) + floor * floor * (1.0 + widening * widening);
  at_centre(0, 1) = at_centre(1, 0) = variance * both / (ss * n);
  at_centre(1, 1) = variance * r / (n * n) + parameters_.floor_r * parameters_.floor_r;
  Eigen::Matrix2d to_foot;
  to_foot << 1.0, 0.0, along.dot(fit.centre), 1.0;
  return {fit.alpha, fit.r, to_foot * at_centre * to_foot.transpose(), line.extent,
          static_cast<int>(n)};
}

}  // namespace libslam
