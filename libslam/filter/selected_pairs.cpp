#include <algorithm>

#include <libslam/filter/selected_pairs.hpp>

namespace libslam {

using Eigen::Index;

void SelectedPairs::clear() {
  pairs_.clear();
  columns_.clear();
  rows_ = 0;
}

void SelectedPairs::add(const LinearizedMeasurement& measurement) {
  const std::size_t first = columns_.size();
  for (const auto& [block, jacobian] : measurement.wrt) columns_.push_back({block, 0, jacobian});
  pairs_.push_back({measurement.innovation, measurement.cov, first, columns_.size(), rows_});
  rows_ += measurement.innovation.size();
}

void SelectedPairs::place_blocks(const GaussianState& state) {
  constexpr Index kAbsent = -1;
  blocks_.clear();
  block_rows_ = 0;
  for (const Column& column : columns_) {
    const auto index = static_cast<std::size_t>(column.block.value);
    if (row_of_.size() <= index) row_of_.resize(index + 1);
    row_of_[index] = kAbsent;
  }
  for (Column& column : columns_) {
    Index& row = row_of_[static_cast<std::size_t>(column.block.value)];
    if (row == kAbsent) {
      row = block_rows_;
      block_rows_ += state.size(column.block);
      blocks_.push_back(column.block);
    }
    column.row = row;
  }
}

void SelectedPairs::finish(const GaussianState& state) {
  place_blocks(state);
  if (p_.rows() < block_rows_) p_.resize(2 * block_rows_, 2 * block_rows_);
  if (pht_.rows() < block_rows_ || pht_.cols() < rows_) pht_.resize(2 * block_rows_, 2 * rows_);
  Index col = 0;
  for (const BlockId second : blocks_) {
    const Index cols = state.size(second);
    Index row = 0;
    for (const BlockId first : blocks_) {
      const Index rows = state.size(first);
      state.covariance().marginal(state.offset(first), state.offset(second),
                                  p_.block(row, col, rows, cols));
      row += rows;
    }
    col += cols;
  }
  for (const Pair& pair : pairs_) {
    auto pht = pht_.block(0, pair.first_row, block_rows_, pair.innovation.size());
    pht.setZero();
    for (std::size_t k = pair.first_column; k < pair.end_column; ++k) {
      const Column& column = columns_[k];
      pht.noalias() += p_.block(0, column.row, block_rows_, column.jacobian.cols()) *
                       column.jacobian.transpose();
    }
  }
}

MeasurementMatrix SelectedPairs::covariance(std::size_t first, std::size_t second) const {
  const Pair& pair = pairs_[first];
  const Pair& other = pairs_[second];
  MeasurementMatrix sum = MeasurementMatrix::Zero(pair.innovation.size(), other.innovation.size());
  for (std::size_t k = pair.first_column; k < pair.end_column; ++k) {
    const Column& column = columns_[k];
    sum += column.jacobian.lazyProduct(
        pht_.block(column.row, other.first_row, column.jacobian.cols(), other.innovation.size()));
  }
  if (first == second) sum += pair.noise;
  return sum;
}

}  // namespace libslam
