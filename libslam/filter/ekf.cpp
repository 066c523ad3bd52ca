#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>

#include <libslam/filter/ekf.hpp>
#include <libslam/state/symmetric_kernel.hpp>

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

Index padded(Index size) {
  return (size + kKernelTile - 1) / kKernelTile * kKernelTile;
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

bool Ekf::weigh(GaussianState& state, std::span<const LinearizedMeasurement> measurements) {
  weighed_ = stack(state, measurements);
  state.covariance().observe(rows_, s_.topLeftCorner(weighed_, weighed_));
  if (!factorize(measurements, weighed_)) return false;
  nis_ = squared_distance(weighed_);
  return true;
}

Correction Ekf::solve(GaussianState& state, std::span<const BlockId> considered) {
  const Index m = weighed_, n = state.dimension();
  if (delta_.size() < n) delta_.resize(2 * n);
  considered_.clear();
  for (const BlockId block : considered)
    for (Index i = 0; i < state.size(block); ++i) considered_.push_back(state.offset(block) + i);
  state.covariance().gain(s_.topLeftCorner(m, m), white_.head(m), considered_, delta_.head(n));
  step_size_ = n;
  return {true, nis_, static_cast<int>(m)};
}

void Ekf::apply(GaussianState& state, BlockId pose) {
  state.covariance().correct(move(state, pose));
}

ChartChange Ekf::move(GaussianState& state, BlockId pose) const {
  return frame_->retract(state, pose, step());
}

Correction Ekf::correct(GaussianState& state, BlockId pose,
                        std::span<const LinearizedMeasurement> measurements,
                        std::span<const BlockId> considered) {
  if (measurements.empty() || !weigh(state, measurements)) return {};
  const Correction correction = solve(state, considered);
  apply(state, pose);
  return correction;
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

/// L^-T, upper triangular, in whole tiles; what stands before a tile's own columns is zero.
void Ekf::invert_factor(Index m) {
  std::fill_n(divided_.data(), divided_.outerStride() * m, 0.0);
  divided_.diagonal().head(m).setOnes();
  for (Index first = 0; first < m; first += kKernelTile)
    symmetric_kernels().front().divide({&divided_(first, first), divided_.outerStride(),
                                        std::min<Index>(kKernelTile, m - first), &s_(first, first),
                                        s_.outerStride(), m - first});
}

/// S^-1 nu and the first kDiagonals diagonals of S^-1 = L^-T L^-1: sums of products of neighbours
/// within the columns of L^-T, four rows at a time.
template <int kDiagonals>
void Ekf::invert_blocks(Index m) {
  constexpr int kLanes = 4;
  using Lanes = Eigen::Array<double, kLanes, 1>;
  for (Index r = 0; r < m; r += kLanes) {
    Lanes weighted = Lanes::Zero();
    std::array<Lanes, kDiagonals> sums;
    sums.fill(Lanes::Zero());
    for (Index k = r; k < m; ++k) {
      const double* column = &divided_(r, k);
      const Lanes x = Eigen::Map<const Lanes>(column);
      weighted += white_[k] * x;
      for (std::size_t b = 0; b < kDiagonals; ++b)
        sums[b] += x * Eigen::Map<const Lanes>(column + b);
    }
    weighted_.segment<kLanes>(r) = weighted;
    for (std::size_t b = 0; b < kDiagonals; ++b)
      diagonals_.col(static_cast<Index>(b)).segment<kLanes>(r) = sums[b];
  }
}

void Ekf::look_back(std::span<const LinearizedMeasurement> measurements,
                    std::vector<Postfit>& out) {
  const Index m = weighed_;
  reserve_divided(m);
  invert_factor(m);
  Index widest = 0;
  for (const auto& measurement : measurements)
    widest = std::max(widest, measurement.innovation.size());
  if (widest <= 2)
    invert_blocks<2>(m);
  else
    invert_blocks<kMaxMeasurementDimension>(m);
  out.resize(measurements.size());
  Index row = 0;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const Index rows = measurements[i].innovation.size();
    Postfit& postfit = out[i];
    postfit.innovation = measurements[i].innovation;
    postfit.cov_innovation = own_[i];
    postfit.weighted = weighted_.segment(row, rows);
    postfit.information.resize(rows, rows);
    for (Index c = 0; c < rows; ++c)
      for (Index r = c; r < rows; ++r)
        postfit.information(r, c) = postfit.information(c, r) = diagonals_(row + c, r - c);
    row += rows;
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
  if (divided_.cols() >= m) return;
  const Index capacity = std::max<Index>(2 * m, kMaxTangent);
  divided_.setZero(padded(capacity) + kMaxMeasurementDimension, capacity);
  diagonals_.resize(padded(capacity), kMaxMeasurementDimension);
  weighted_.resize(padded(capacity));
}

}  // namespace libslam
