#pragma once
// Innovations of several pairs and how they covary: what joint tests of association ask for.

#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/state/gaussian_state.hpp>
#include <libslam/state/linearization.hpp>

namespace libslam {

/// P H^T of all pairs is computed once, over the blocks that occur in some pair, so that a block of
/// H P H^T costs a few products, however large the state. Keeps its memory from frame to frame.
class SelectedPairs {
 public:
  void clear();
  void add(const LinearizedMeasurement& measurement);
  /// To be called when all are added, before the questions below.
  void finish(const GaussianState& state);

  std::size_t size() const { return pairs_.size(); }
  const MeasurementVector& innovation(std::size_t pair) const { return pairs_[pair].innovation; }
  const MeasurementMatrix& noise(std::size_t pair) const { return pairs_[pair].noise; }
  /// H_first P H_second^T, plus the noise where both are the same pair.
  MeasurementMatrix covariance(std::size_t first, std::size_t second) const;

 private:
  struct Column {
    BlockId block;
    Eigen::Index row;  // of the block in p_ and pht_
    BlockMatrix jacobian;
  };
  struct Pair {
    MeasurementVector innovation;
    MeasurementMatrix noise;
    std::size_t first_column, end_column;
    Eigen::Index first_row;
  };
  void place_blocks(const GaussianState& state);

  std::vector<Pair> pairs_;
  std::vector<Column> columns_;
  std::vector<BlockId> blocks_;       // that occur, each once
  std::vector<Eigen::Index> row_of_;  // by BlockId::value, of those in blocks_
  Eigen::Index rows_ = 0, block_rows_ = 0;
  Eigen::MatrixXd p_, pht_;  // leading parts of larger matrices
};

}  // namespace libslam
