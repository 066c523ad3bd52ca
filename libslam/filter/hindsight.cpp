#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Cholesky>

#include <libslam/filter/hindsight.hpp>

namespace libslam {

namespace {

using Eigen::Index;

Index positions(const GaussianState& state, BlockId pose) {
  return state.spec(pose).chart == Chart::kSE3 ? 3 : 2;
}

}  // namespace

Hindsight::Hindsight(double slip_probability) : odds_(slip_probability / (1.0 - slip_probability)) {
  if (!(slip_probability > 0.0 && slip_probability < 1.0))
    throw std::invalid_argument("the probability of a slip must be in (0, 1), got " +
                                std::to_string(slip_probability));
}

void Hindsight::open(GaussianState& state, BlockId pose) {
  while (added_ < kLookBack) {
    const BlockSpec spec{"slip " + std::to_string(added_), Chart::kVector, 1, WorldRole::kNone};
    shadows_[added_++] = state.add(spec, Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Zero(1, 1));
  }
  const Index n = positions(state, pose);
  const auto clear = [&state](BlockId shadow) {
    state.covariance().propagate(state.offset(shadow), {}, BlockMatrix::Zero(1, 1));
    state.set_estimate(shadow, Eigen::VectorXd::Zero(1));
  };
  if (!begun_) {
    for (const BlockId shadow : shadows_) clear(shadow);
    last_position_ = state.estimate(pose).head(n);
    begun_ = true;
  }
  const BlockId shadow = shadows_[next_];
  next_ = (next_ + 1) % kLookBack;
  clear(shadow);
  BlockMatrix travel = BlockMatrix::Zero(1, state.size(pose));
  travel.leftCols(n) = (state.estimate(pose).head(n) - last_position_).transpose();
  state.covariance().couple(state.offset(shadow), state.offset(pose), travel);
}

bool Hindsight::reconsider(GaussianState& state, BlockId pose, Ekf& ekf,
                           std::span<const BlockId> given) {
  gather(state);
  const auto [first, length] = slipped();
  if (length > 0) {
    const Evidence shifted =
        Evidence::Identity(length, length) + c_.block(first, first, length, length);
    const Eigen::LLT<Evidence> factor(shifted);  // L L^T = M^-1
    const Evidence root = factor.matrixU().solve(Evidence::Identity(length, length));
    const Shift white = factor.matrixL().solve(d_.segment(first, length));
    ekf.spread(state, pose,
               std::span(order_).subspan(static_cast<std::size_t>(first),
                                         static_cast<std::size_t>(length)),
               root, white, given);
  }
  last_position_ = state.estimate(pose).head(last_position_.size());
  return length > 0;
}

void Hindsight::gather(const GaussianState& state) {
  c_.resize(kMost, kMost);
  d_.resize(kMost);
  for (std::size_t k = 0; k < kLookBack; ++k) order_[k] = shadows_[(next_ + k) % kLookBack];
  for (Index i = 0; i < kMost; ++i) {
    const BlockId shadow = order_[static_cast<std::size_t>(i)];
    d_[i] = state.estimate(shadow)[0];
    for (Index k = 0; k <= i; ++k)
      c_(i, k) = c_(k, i) =
          -state.cross_covariance(shadow, order_[static_cast<std::size_t>(k)])(0, 0);
  }
}

// One factor per first interval serves all rows that begin there: those of the leading parts of a
// matrix are the leading parts of its factor.
std::pair<Index, Index> Hindsight::slipped() const {
  double sum = 0.0, best = 0.0;
  int rows = 0;
  std::pair<Index, Index> likeliest{0, 0};
  for (Index first = 0; first < kMost; ++first) {
    const Index n = kMost - first;
    const Evidence shifted = Evidence::Identity(n, n) + c_.bottomRightCorner(n, n);
    const Eigen::LLT<Evidence> factor(shifted);
    if (factor.info() != Eigen::Success) continue;
    const Shift white = factor.matrixL().solve(d_.tail(n));
    double log_ratio = 0.0;
    for (Index k = 0; k < n; ++k, ++rows) {
      log_ratio += 0.5 * white[k] * white[k] - std::log(factor.matrixLLT()(k, k));
      sum += std::exp(log_ratio);
      if (log_ratio > best) {
        best = log_ratio;
        likeliest = {first, k + 1};
      }
    }
  }
  if (rows == 0 || !(odds_ * sum > rows)) return {0, 0};
  return likeliest;
}

}  // namespace libslam
