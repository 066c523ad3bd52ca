#include <algorithm>
#include <cstdio>

#include <Eigen/QR>

#include <libslam/frontend/odometry_check.hpp>

namespace libslam {

namespace {

// Smaller movements are standstill: rounding of a logged pose.
constexpr double kLeastMovement = 1e-6;
// Standing readings are compared too (a wheel that turns on the spot is wrong), up to this many.
constexpr std::size_t kMostPairs = 4 * FieldCheck::kReadings;
// Wheel travel per encoder tick of anything that drives [m].
constexpr double kLeastMetresPerTick = 1e-7;
constexpr double kMostMetresPerTick = 1.0;
// See the header: what is left of a turn on a straight path, and of a distance in a turn on the
// spot.
constexpr double kLeastTurnPerMetre = 0.1;
constexpr double kLeastMetresPerTurn = 0.1;

std::string describe_error(const char* what, double error, double tolerance) {
  char text[128];
  std::snprintf(text, sizeof text,
                "%s differs from the pose increments by %.3g of it, allowed %.3g", what, error,
                tolerance);
  return text;
}

}  // namespace

void FieldCheck::note_present() {
  if (verdict_ == FieldVerdict::kAbsent) verdict_ = FieldVerdict::kUndecided;
}

void FieldCheck::condemn(std::int64_t step, const std::string& reason) {
  if (verdict_ == FieldVerdict::kInsane) return;
  verdict_ = FieldVerdict::kInsane;
  reason_ = "step " + std::to_string(step) + ": " + reason;
}

void FieldCheck::observe(std::int64_t step, const Eigen::Vector2d& reading,
                         const Eigen::Vector2d& movement) {
  note_present();
  if (verdict_ != FieldVerdict::kUndecided) return;
  const bool moving = movement.cwiseAbs().maxCoeff() > kLeastMovement;
  if (moving) ++moving_;
  if (moving || pairs_.size() < kMostPairs) pairs_.push_back({reading, movement});
  if (moving_ < kReadings) return;
  const std::string disagreement = find_disagreement();
  pairs_ = {};
  if (disagreement.empty()) {
    verdict_ = FieldVerdict::kSane;
  } else {
    condemn(step, disagreement);
  }
}

std::string FieldCheck::find_disagreement() const {
  const auto count = static_cast<Eigen::Index>(pairs_.size());
  Eigen::MatrixX2d readings(count, 2);
  Eigen::MatrixX2d movements(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) {
    readings.row(i) = pairs_[static_cast<std::size_t>(i)].reading;
    movements.row(i) = pairs_[static_cast<std::size_t>(i)].movement;
  }
  if (relation_ == Relation::kProportional) {
    // Minimum norm, because equal ticks of a straight drive leave the difference of the wheels
    // open.
    const Eigen::Matrix2d map = readings.completeOrthogonalDecomposition().solve(movements);
    const double metres_per_tick = map.col(0).sum();
    if (!(metres_per_tick >= kLeastMetresPerTick && metres_per_tick <= kMostMetresPerTick)) {
      return describe_error("the travel of the ticks", 1.0, tolerance_);
    }
    readings = (readings * map).eval();
  }
  const Eigen::RowVector2d moved = movements.colwise().norm();
  const double distance = std::max(moved[0], kLeastMetresPerTurn * moved[1]);
  const double turn = std::max(moved[1], kLeastTurnPerMetre * moved[0]);
  const Eigen::RowVector2d error = (readings - movements).colwise().norm();
  if (!(error[0] <= tolerance_ * distance)) {
    return describe_error("distance", error[0] / distance, tolerance_);
  }
  if (!(error[1] <= tolerance_ * turn)) {
    return describe_error("turn", error[1] / turn, tolerance_);
  }
  return {};
}

}  // namespace libslam
