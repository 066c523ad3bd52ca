#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <libslam/frontend/scan_matching.hpp>

namespace libslam {

namespace {

constexpr std::size_t kFewestPoints = 20, kFewestPairs = 10;
constexpr double kClosest = 0.1;           // nearer echoes are the robot's own [m]
constexpr double kResolution = 0.005;      // of ranges: residuals are not trusted further [m]
constexpr double kAlike = 0.94;            // cosine between two normals of one surface: 20 deg
constexpr double kCut = 4.5;               // residuals beyond so many spreads do not count
constexpr double kFits = 0.1;              // [m]
constexpr double kNarrowest = 0.1;         // of the search for neighbours at the end [m]
constexpr double kNoiseOfReference = 2.0;  // variance with the reference's noise per variance
constexpr double kGood = 0.6;              // a match with more points that fit is not doubted
constexpr double kBetter = 0.05;           // another start must gain this share to win
constexpr double kTurn = 0.15;             // between starts [rad]
constexpr int kTurns = 4;                  // other starts to either side
constexpr double kStill = 1e-5;            // smaller steps end the search [m, rad]
constexpr double kSettled = 0.01;          // smaller steps narrow it [m, rad]

double square(double x) {
  return x * x;
}

/// T - guess, the turn wrapped.
Eigen::Vector3d difference(const Eigen::Vector3d& T, const Eigen::Vector3d& guess) {
  Eigen::Vector3d d = T - guess;
  d[2] = std::remainder(d[2], 2.0 * kPi);
  return d;
}

/// What noise of the normals pretends to know may be more than a blind direction has.
Eigen::Matrix3d without_negative(const Eigen::Matrix3d& hessian) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(hessian);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

}  // namespace

ScanMatcher::ScanMatcher(const ScanMatchingParameters& parameters) : parameters_(parameters) {}

bool ScanMatcher::look(const mrpt::obs::CObservation2DRangeScan& scan) {
  read_beam_points(scan, {kClosest, parameters_.max_range}, points_);
  current_.clear();
  if (points_.size() < kFewestPoints) return false;
  current_origin_ = {scan.sensorPose.x(), scan.sensorPose.y()};
  find_surface(points_, {scan.sensorPose.x(), scan.sensorPose.y(), scan.sensorPose.yaw()},
               current_);
  return true;
}

void ScanMatcher::renew_reference() {
  reference_.swap(current_);
  origin_ = current_origin_;
}

const SurfacePoint* ScanMatcher::nearest(const Eigen::Vector2d& q, double limit) const {
  const Eigen::Vector2d seen = q - origin_;
  const double range = seen.norm(), bearing = std::atan2(seen.y(), seen.x());
  const auto middle = std::lower_bound(
      reference_.begin(), reference_.end(), bearing,
      [](const SurfacePoint& point, double value) { return point.bearing < value; });
  const SurfacePoint* best = nullptr;
  double best2 = limit * limit;
  // True while a point at so much another bearing could be nearer than the best.
  const auto closer = [&](const SurfacePoint& point) {
    const double off = std::abs(point.bearing - bearing);
    if (square(off < 0.5 * kPi ? range * std::sin(off) : range) > best2) return false;
    const double d2 = (point.p - q).squaredNorm();
    if (d2 < best2) {
      best2 = d2;
      best = &point;
    }
    return true;
  };
  for (auto up = middle; up != reference_.end() && closer(*up);) ++up;
  for (auto down = middle; down != reference_.begin() && closer(*std::prev(down));) --down;
  return best;
}

double ScanMatcher::pair(const Eigen::Vector3d& T, double limit) {
  const Eigen::Rotation2Dd R(T[2]);
  const Eigen::Matrix2d rotation = R.toRotationMatrix();
  std::size_t paired = 0;
  pairs_.clear();
  for (const SurfacePoint& point : current_) {
    const Eigen::Vector2d q = T.head<2>() + rotation * point.p;
    const SurfacePoint* other = nearest(q, limit);
    if (other == nullptr) continue;
    ++paired;
    if (!other->smooth || !point.smooth || other->n.dot(rotation * point.n) < kAlike) continue;
    pairs_.push_back({q, other->n, other->foot, other->n.dot(q - other->foot), other->var_turn});
  }
  return static_cast<double>(paired) / static_cast<double>(current_.size());
}

double ScanMatcher::spread_of_residuals() {
  residuals_.clear();
  for (const Pair& pair : pairs_) residuals_.push_back(std::abs(pair.residual));
  const auto middle = residuals_.begin() + static_cast<std::ptrdiff_t>(residuals_.size() / 2);
  std::nth_element(residuals_.begin(), middle, residuals_.end());
  return std::max(kResolution, 1.4826 * *middle);
}

double ScanMatcher::share_that_fits(double paired) const {
  const auto fitting = std::count_if(pairs_.begin(), pairs_.end(), [](const Pair& pair) {
    return std::abs(pair.residual) < kFits;
  });
  return paired * static_cast<double>(fitting) / static_cast<double>(pairs_.size());
}

ScanMatcher::Sums ScanMatcher::add_up(const Eigen::Vector3d& T, double cut) const {
  Sums sums{Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()};
  for (const Pair& pair : pairs_) {
    const double u = square(pair.residual / cut);
    if (u >= 1.0) continue;
    const double weight = square(1.0 - u);
    const Eigen::Vector2d arm = pair.q - T.head<2>();
    const auto derivative = [&arm](const Eigen::Vector2d& n) {
      return Eigen::Vector3d(n.x(), n.y(), n.y() * arm.x() - n.x() * arm.y());
    };
    const Eigen::Vector3d across = derivative(pair.n);
    const Eigen::Vector3d along = derivative({-pair.n.y(), pair.n.x()});
    sums.hessian +=
        weight * (across * across.transpose() - pair.var_turn * along * along.transpose());
    sums.gradient += weight * pair.residual * across;
  }
  sums.hessian = without_negative(sums.hessian);
  return sums;
}

std::optional<ScanMatcher::Minimum> ScanMatcher::minimize(const Eigen::Vector3d& start,
                                                          const Eigen::Vector3d& guess,
                                                          const Eigen::Matrix3d& information) {
  Minimum minimum;
  minimum.T = start;
  double limit = parameters_.max_correspondence, widest = 0.5 * limit, paired = 0.0;
  for (int i = 0; i < parameters_.max_iterations; ++i, widest *= 0.5) {
    ++iterations_;
    paired = pair(minimum.T, limit);
    if (pairs_.size() < kFewestPairs || paired < parameters_.min_overlap) return std::nullopt;
    minimum.spread = spread_of_residuals();
    const double narrow = kCut * minimum.spread;
    minimum.sums = add_up(minimum.T, std::max(narrow, widest));
    const double var = kNoiseOfReference * square(minimum.spread);
    const Eigen::Matrix3d hessian = minimum.sums.hessian / var + information;
    const Eigen::Vector3d gradient =
        minimum.sums.gradient / var + information * difference(minimum.T, guess);
    const Eigen::Vector3d step = -hessian.ldlt().solve(gradient);
    if (!step.allFinite()) return std::nullopt;
    minimum.T += step;
    minimum.sums.gradient += minimum.sums.hessian * step;
    const double largest = step.cwiseAbs().maxCoeff();
    if (largest < kSettled) limit = std::max({kNarrowest, kCut * minimum.spread, 0.5 * limit});
    if (largest < kStill && widest <= narrow) break;
  }
  minimum.fitting = share_that_fits(paired);
  if (minimum.fitting < parameters_.min_overlap) return std::nullopt;
  return minimum;
}

ScanMatch ScanMatcher::gaussian(const Minimum& minimum, const Eigen::Vector3d& guess) const {
  ScanMatch match;
  const double var = kNoiseOfReference * square(minimum.spread);
  const Eigen::Matrix3d L = minimum.sums.hessian / var;
  const Eigen::Vector3d pull = L * difference(minimum.T, guess) - minimum.sums.gradient / var;
  const double sigma_turn = parameters_.floor_heading_deg * kPi / 180.0;
  const Eigen::Vector3d floor(square(parameters_.floor_xy), square(parameters_.floor_xy),
                              square(sigma_turn));
  const Eigen::PartialPivLU<Eigen::Matrix3d> damping(Eigen::Matrix3d::Identity() +
                                                     L * floor.asDiagonal());
  const Eigen::Matrix3d damped = damping.solve(L);
  match.information = 0.5 * (damped + damped.transpose());
  match.pull = damping.solve(pull);
  match.fitting = minimum.fitting;
  match.spread = minimum.spread;
  match.iterations = iterations_;
  return match;
}

std::optional<ScanMatch> ScanMatcher::match(const Eigen::Vector3d& guess,
                                            const Eigen::Matrix3d& information) {
  if (current_.empty() || reference_.empty()) return std::nullopt;
  iterations_ = 0;
  std::optional<Minimum> best = minimize(guess, guess, information);
  const bool doubtful = !best || best->fitting < kGood;
  for (int i = 1; doubtful && i <= kTurns; ++i)
    for (const double turn : {-kTurn * i, kTurn * i}) {
      const auto other = minimize(guess + Eigen::Vector3d(0.0, 0.0, turn), guess, information);
      if (other && (!best || other->fitting > best->fitting + kBetter)) best = other;
    }
  if (!best) return std::nullopt;
  return gaussian(*best, guess);
}

}  // namespace libslam
