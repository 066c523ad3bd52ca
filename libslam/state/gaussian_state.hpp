#pragma once
// The Gaussian state: named blocks, their estimates, and one covariance over their errors.

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <libslam/state/block.hpp>
#include <libslam/state/covariance_store.hpp>
#include <libslam/state/linearization.hpp>

namespace libslam {

/// Blocks keep the order in which they were added: pose and calibration first, then landmarks.
/// The covariance is always that of the additive (standard) error of the current estimate, whatever
/// the error frame of the filter (see error_frame.hpp). All methods throw std::invalid_argument
/// naming the block and the dimensions when sizes do not fit, std::out_of_range for a dead handle.
class GaussianState {
 public:
  /// State over an empty dense symmetric store.
  GaussianState();
  explicit GaussianState(std::unique_ptr<CovarianceStore> covariance);
  GaussianState(const GaussianState& other);
  GaussianState& operator=(const GaussianState& other);
  GaussianState(GaussianState&&) = default;
  GaussianState& operator=(GaussianState&&) = default;

  /// Adds a block that is independent of all others. `estimate`: storage, `cov`: tangent x tangent.
  BlockId add(const BlockSpec& spec, const VectorRef& estimate, const MatrixRef& cov);
  /// Adds a block that is a function of others (a new landmark, a cloned pose).
  BlockId augment(const BlockSpec& spec, const Initialization& initialization);
  /// Adds a copy of a block, fully correlated with it: the same now, free to differ later.
  BlockId clone(BlockId block, const std::string& name);
  /// Adds a block that is known exactly: it has an estimate and no error, so it takes no room in
  /// the covariance and costs nothing there. Its covariances are zero; derivatives with respect to
  /// it are left out by the filter.
  BlockId add_constant(const BlockSpec& spec, const VectorRef& estimate);
  /// Marginalizes a block out.
  void remove(BlockId block);
  /// Makes room for `tangent` coordinates.
  void reserve(Eigen::Index tangent);

  std::optional<BlockId> find(std::string_view name) const;
  /// Live blocks with an error, in state order; constants are not among them.
  const std::vector<BlockId>& blocks() const { return order_; }
  const BlockSpec& spec(BlockId block) const { return slot(block).spec; }
  bool alive(BlockId block) const;
  bool is_constant(BlockId block) const { return slot(block).constant; }

  /// Dimension of the error (rows of the covariance).
  Eigen::Index dimension() const { return dimension_; }
  /// First tangent coordinate of a block.
  Eigen::Index offset(BlockId block) const { return slot(block).offset; }
  /// Length of the error of a block; 0 of a constant.
  Eigen::Index size(BlockId block) const { return slot(block).tangent; }

  /// Estimate of a block, storage coordinates.
  Eigen::Map<const Eigen::VectorXd> estimate(BlockId block) const;
  void set_estimate(BlockId block, const VectorRef& estimate);
  /// What an error frame needs to move a block: one look-up instead of several.
  struct MutableBlock {
    const BlockSpec& spec;
    Eigen::Index offset, size;             ///< of its error
    Eigen::Map<Eigen::VectorXd> estimate;  ///< storage coordinates, changed in place
  };
  /// Valid until a block is added or removed. Not for constants.
  MutableBlock mutable_block(BlockId block);
  /// Covariance of one block, tangent x tangent.
  BlockMatrix covariance_of(BlockId block) const;
  /// Cross-covariance of two blocks.
  BlockMatrix cross_covariance(BlockId row, BlockId col) const;
  /// The whole covariance, full symmetric; for reports and tests.
  Eigen::MatrixXd full_covariance() const;

  CovarianceStore& covariance() { return *covariance_; }
  const CovarianceStore& covariance() const { return *covariance_; }

 private:
  struct Slot {
    BlockSpec spec;
    Eigen::Index offset = 0, tangent = 0, storage_offset = 0, storage = 0;
    bool alive = false, constant = false;
  };
  const Slot& slot(BlockId block) const;
  int free_slot();
  BlockId append(const BlockSpec& spec, const VectorRef& estimate);

  std::vector<Slot> slots_;
  std::vector<BlockId> order_;
  std::vector<int> free_;
  Eigen::VectorXd storage_;  // capacity; used_ of it is live
  std::vector<double> constants_;
  Eigen::Index used_ = 0, dimension_ = 0;
  std::unique_ptr<CovarianceStore> covariance_;
};

}  // namespace libslam
