#include <algorithm>
#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>

#include <libslam/filter/iterated_update.hpp>

namespace libslam {

namespace {

/// Mean square, in standard deviations of the measurements: far below their noise.
constexpr double kNegligible = 0.01;

/// H <- H T, T = I + U E^T: from the error of the estimate that moved to that of the one before.
void change_chart(const GaussianState& state, BlockId pose, const ChartChange& change,
                  LinearizedMeasurement& measurement) {
  const Eigen::Index turns = change.u.cols();
  if (turns == 0) return;
  MeasurementMatrix by_turn = MeasurementMatrix::Zero(measurement.innovation.size(), turns);
  for (const auto& [block, jacobian] : measurement.wrt)
    if (!state.is_constant(block))
      by_turn += jacobian.lazyProduct(change.u.middleRows(state.offset(block), jacobian.cols()));
  for (auto& [block, jacobian] : measurement.wrt)
    if (block == pose) jacobian.middleCols(change.offset - state.offset(pose), turns) += by_turn;
}

}  // namespace

IteratedUpdate::IteratedUpdate(int linearizations) : linearizations_(linearizations) {
  if (linearizations < 1)
    throw std::invalid_argument("an update needs a linearization, not " +
                                std::to_string(linearizations));
}

Correction IteratedUpdate::correct(GaussianState& state, Ekf& ekf, BlockId pose,
                                   std::span<LinearizedMeasurement> measurements,
                                   std::span<const BlockId> considered,
                                   const Relinearize& relinearize) {
  if (measurements.empty() || !ekf.weigh(state, measurements)) return {};
  Correction correction = ekf.solve(state, considered);
  for (int k = 1; k < linearizations_; ++k) {
    if (!linearize_there(state, ekf, pose, measurements, relinearize) || agrees(measurements))
      break;
    std::copy(again_.begin(), again_.end(), measurements.begin());
    if (!ekf.weigh(state, measurements)) return {};
    correction = ekf.solve(state, considered);
  }
  ekf.apply(state, pose);
  return correction;
}

bool IteratedUpdate::linearize_there(GaussianState& state, const Ekf& ekf, BlockId pose,
                                     std::span<const LinearizedMeasurement> measurements,
                                     const Relinearize& relinearize) {
  kept_.clear();
  for (const BlockId block : state.blocks()) kept_.emplace_back(state.estimate(block));
  again_.assign(measurements.begin(), measurements.end());
  const ChartChange change = ekf.move(state, pose);
  const auto delta = ekf.step();
  bool visible = true;
  for (std::size_t i = 0; visible && i < again_.size(); ++i) {
    LinearizedMeasurement& measurement = again_[i];
    relinearize(i, measurement);
    change_chart(state, pose, change, measurement);
    for (const auto& [block, jacobian] : measurement.wrt)
      if (!state.is_constant(block))
        measurement.innovation += jacobian * delta.segment(state.offset(block), jacobian.cols());
    visible = measurement.innovation.allFinite();
  }
  auto kept = kept_.begin();
  for (const BlockId block : state.blocks()) state.set_estimate(block, *kept++);
  return visible;
}

bool IteratedUpdate::agrees(std::span<const LinearizedMeasurement> measurements) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const MeasurementVector rest = again_[i].innovation - measurements[i].innovation;
    sum += rest.dot(measurements[i].cov.llt().solve(rest));
  }
  return sum <= kNegligible * static_cast<double>(measurements.size());
}

}  // namespace libslam
