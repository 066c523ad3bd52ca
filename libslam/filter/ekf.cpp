#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>

#include <libslam/filter/ekf.hpp>

namespace libslam {

namespace {

using Eigen::Index;

[[noreturn]] void throw_shape(const GaussianState& state, BlockId block,
                              const BlockMatrix& jacobian, Index rows) {
  throw std::invalid_argument("Jacobian with respect to block '" + state.spec(block).name +
                              "' is " + std::to_string(jacobian.rows()) + " x " +
                              std::to_string(jacobian.cols()) + ", expected " +
                              std::to_string(rows) + " x " + std::to_string(state.size(block)));
}

PlacedJacobian place(const GaussianState& state, const BlockJacobian& column, Index rows) {
  if (column.jacobian.rows() != rows || column.jacobian.cols() != state.size(column.block))
    throw_shape(state, column.block, column.jacobian, rows);
  return {state.offset(column.block), column.jacobian};
}

}  // namespace

Ekf::Ekf(std::unique_ptr<ErrorFrame> frame) : frame_(std::move(frame)) {
  if (!frame_) throw std::invalid_argument("Ekf needs an error frame");
}

void Ekf::propagate(GaussianState& state, const MotionStep& step) {
  const Index d = state.size(step.target);
  if (step.cov_noise.rows() != d || step.cov_noise.cols() != d)
    throw_shape(state, step.target, step.cov_noise, d);
  std::array<PlacedJacobian, BlockJacobians::kCapacity> placed;
  std::size_t count = 0;
  for (const auto& column : step.wrt) placed[count++] = place(state, column, d);
  state.covariance().propagate(state.offset(step.target), std::span(placed.data(), count),
                               step.cov_noise);
  state.set_estimate(step.target, step.estimate);
}

Index Ekf::stack(const GaussianState& state, std::span<const LinearizedMeasurement> measurements) {
  std::size_t columns = 0;
  Index m = 0;
  for (const auto& measurement : measurements) {
    columns += static_cast<std::size_t>(measurement.wrt.size());
    m += measurement.innovation.size();
  }
  placed_.clear();
  placed_.reserve(columns);  // spans into placed_ must stay valid
  rows_.clear();
  if (s_.rows() < m) {
    s_.resize(2 * m, 2 * m);
    nu_.resize(2 * m);
    white_.resize(2 * m);
  }
  Index row = 0;
  for (const auto& measurement : measurements) {
    const Index rows = measurement.innovation.size();
    if (measurement.cov.rows() != rows || measurement.cov.cols() != rows)
      throw std::invalid_argument("measurement of dimension " + std::to_string(rows) + " has a " +
                                  std::to_string(measurement.cov.rows()) + " x " +
                                  std::to_string(measurement.cov.cols()) + " covariance");
    const std::size_t first = placed_.size();
    for (const auto& column : measurement.wrt)
      if (!state.is_constant(column.block)) placed_.push_back(place(state, column, rows));
    rows_.push_back({row, rows, std::span(placed_.data() + first, placed_.size() - first)});
    nu_.segment(row, rows) = measurement.innovation;
    row += rows;
  }
  return m;
}

bool Ekf::factorize(std::span<const LinearizedMeasurement> measurements, Index m) {
  own_.clear();
  Index row = 0;
  for (const auto& measurement : measurements) {
    const Index rows = measurement.innovation.size();
    auto own = s_.block(row, row, rows, rows);
    own += measurement.cov;
    own_.emplace_back(own);
    row += rows;
  }
  Eigen::Ref<Eigen::MatrixXd> s = s_.topLeftCorner(m, m);
  return Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(s).info() == Eigen::Success;
}

double Ekf::squared_distance(Index m) {
  double sum = 0.0;
  for (Index k = 0; k < m; ++k) {
    white_[k] = (nu_[k] - s_.row(k).head(k).dot(white_.head(k))) / s_(k, k);
    sum += white_[k] * white_[k];
  }
  return sum;
}

Innovation Ekf::innovate(const GaussianState& state, const LinearizedMeasurement& measurement) {
  const std::span<const LinearizedMeasurement> alone(&measurement, 1);
  const Index m = stack(state, alone);
  state.covariance().project(rows_, s_.topLeftCorner(m, m));
  if (!factorize(alone, m)) return {std::numeric_limits<double>::infinity(), 0.0};
  double log_det = 0.0;
  for (Index k = 0; k < m; ++k) log_det += 2.0 * std::log(s_(k, k));
  return {squared_distance(m), log_det};
}

void Ekf::expect(const GaussianState& state, BlockId pose,
                 std::span<const LinearizedMeasurement> measurements, JointInnovation& out) {
  const Index m = stack(state, measurements);
  out.nu = nu_.head(m);
  out.cov.resize(m, m);
  out.wrt_pose.setZero(m, state.size(pose));
  out.trace_noise = 0.0;
  state.covariance().project(rows_, out.cov);
  Index row = 0;
  for (const auto& measurement : measurements) {
    const Index rows = measurement.innovation.size();
    out.cov.block(row, row, rows, rows) += measurement.cov;
    out.trace_noise += measurement.cov.trace();
    for (const auto& [block, jacobian] : measurement.wrt)
      if (block == pose) out.wrt_pose.middleRows(row, rows) = jacobian;
    row += rows;
  }
}

Correction Ekf::correct(GaussianState& state, BlockId pose,
                        std::span<const LinearizedMeasurement> measurements,
                        std::span<const BlockId> considered) {
  const Correction correction = solve(state, measurements, considered);
  if (correction.applied) apply(state, pose);
  return correction;
}

Correction Ekf::solve(GaussianState& state, std::span<const LinearizedMeasurement> measurements,
                      std::span<const BlockId> considered) {
  step_size_ = 0;
  if (measurements.empty()) return {};
  const Index m = stack(state, measurements);
  state.covariance().observe(rows_, s_.topLeftCorner(m, m));
  if (!factorize(measurements, m)) return {};
  const double nis = squared_distance(m);
  const Index n = state.dimension();
  if (delta_.size() < n) delta_.resize(2 * n);
  considered_.clear();
  for (const BlockId block : considered)
    for (Index i = 0; i < state.size(block); ++i) considered_.push_back(state.offset(block) + i);
  state.covariance().gain(s_.topLeftCorner(m, m), white_.head(m), considered_, delta_.head(n));
  step_size_ = n;
  return {true, nis, static_cast<int>(m)};
}

void Ekf::spread(GaussianState& state, BlockId pose, std::span<const BlockId> shadows,
                 const MatrixRef& root, const VectorRef& white, std::span<const BlockId> kept) {
  placed_.clear();
  placed_.reserve(shadows.size());
  rows_.clear();
  Index m = 0;
  for (const BlockId block : shadows) {
    const Index d = state.size(block);
    placed_.push_back({state.offset(block), BlockMatrix::Identity(d, d)});
    rows_.push_back({m, d, std::span(&placed_.back(), 1)});
    m += d;
  }
  if (s_.rows() < m) s_.resize(2 * m, 2 * m);
  state.covariance().observe(rows_, s_.topLeftCorner(m, m));
  const Index n = state.dimension();
  if (delta_.size() < n) delta_.resize(2 * n);
  considered_.clear();
  for (const BlockId block : kept)
    for (Index i = 0; i < state.size(block); ++i) considered_.push_back(state.offset(block) + i);
  state.covariance().spread(root, white, considered_, delta_.head(n));
  step_size_ = n;
  apply(state, pose);
}

void Ekf::apply(GaussianState& state, BlockId pose) {
  state.covariance().correct(move(state, pose));
}

ChartChange Ekf::move(GaussianState& state, BlockId pose) const {
  return frame_->retract(state, pose, step());
}

// With W = L^-1 [0 .. R_i .. 0]^T, zero above the rows of i:  e_i = W^T L^-1 nu, C_i = R_i - W^T W.
// Plain loops: the blocks are so small that general products and solvers cost several times more.
void Ekf::look_back(std::span<const LinearizedMeasurement> measurements,
                    std::vector<Postfit>& out) {
  Index m = 0;
  for (const auto& measurement : measurements) m += measurement.innovation.size();
  reserve_divided(m);
  out.resize(measurements.size());
  Index row = 0;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const LinearizedMeasurement& measurement = measurements[i];
    const Index rows = measurement.innovation.size();
    Postfit& postfit = out[i];
    postfit.innovation = measurement.innovation;
    postfit.residual.resize(rows);
    postfit.cov_predicted = measurement.cov;
    postfit.cov_innovation = own_[i];
    for (Index c = 0; c < rows; ++c) {
      divide(measurement.cov, row, c, m);
      const auto w = divided_.col(c).segment(row, m - row);
      postfit.residual[c] = w.dot(white_.segment(row, m - row));
      for (Index k = 0; k <= c; ++k) {
        postfit.cov_predicted(k, c) -= w.dot(divided_.col(k).segment(row, m - row));
        postfit.cov_predicted(c, k) = postfit.cov_predicted(k, c);
      }
    }
    row += rows;
  }
}

/// Column `c` of divided_, from `row` to `m`: L^-1 times that column of `cov`, which stands at
/// `row`.
void Ekf::divide(const MeasurementMatrix& cov, Index row, Index c, Index m) {
  auto x = divided_.col(c);
  x.segment(row, cov.rows()) = cov.col(c);
  x.segment(row + cov.rows(), m - row - cov.rows()).setZero();
  for (Index j = row; j < m; ++j) {
    const auto l = s_.col(j).segment(j + 1, m - j - 1);
    x[j] /= s_(j, j);
    x.segment(j + 1, m - j - 1) -= x[j] * l;
  }
}

BlockEvidence Ekf::look_back(std::span<const LinearizedMeasurement> measurements, BlockId block,
                             Index size) {
  Index m = 0;
  for (const auto& measurement : measurements) m += measurement.innovation.size();
  reserve_divided(m);
  auto w = divided_.topLeftCorner(m, size);
  w.setZero();
  Index row = 0;
  for (const auto& measurement : measurements) {
    const Index rows = measurement.innovation.size();
    for (const auto& column : measurement.wrt)
      if (column.block == block) w.middleRows(row, rows) = column.jacobian;
    row += rows;
  }
  s_.topLeftCorner(m, m).triangularView<Eigen::Lower>().solveInPlace(w);
  return {w.transpose() * white_.head(m), w.transpose() * w};
}

void Ekf::reserve_divided(Index m) {
  constexpr Index kWidest = std::max<Index>(kMaxMeasurementDimension, kMaxTangent);
  if (divided_.rows() < m) divided_.resize(2 * m, kWidest);
}

}  // namespace libslam
