#pragma once
// What models hand to filters: numbers and the blocks they belong to. Bounded sizes, no heap.

#include <array>
#include <cassert>

#include <Eigen/Core>

#include <libslam/data/feature.hpp>
#include <libslam/state/block.hpp>

namespace libslam {

/// Derivative of something with respect to one block (columns: tangent of the block).
struct BlockJacobian {
  BlockId block;
  BlockMatrix jacobian;
};

/// The non-zero block columns of a Jacobian.
class BlockJacobians {
 public:
  static constexpr int kCapacity = 10;

  /// Appends a zero column block of the given shape and returns it for filling.
  BlockMatrix& add(BlockId block, Eigen::Index rows, Eigen::Index cols) {
    assert(count_ < kCapacity);
    auto& entry = entries_[static_cast<std::size_t>(count_++)];
    entry.block = block;
    entry.jacobian.setZero(rows, cols);
    return entry.jacobian;
  }
  void clear() { count_ = 0; }
  int size() const { return count_; }
  BlockJacobian* begin() { return entries_.data(); }
  BlockJacobian* end() { return entries_.data() + count_; }
  const BlockJacobian* begin() const { return entries_.data(); }
  const BlockJacobian* end() const { return entries_.data() + count_; }

 private:
  std::array<BlockJacobian, kCapacity> entries_;
  int count_ = 0;
};

/// x_target' = f(x_blocks) + w, w ~ N(0, cov_noise): only `target` changes its estimate.
struct MotionStep {
  BlockId target;
  BlockVector estimate;   ///< new estimate of `target`, storage coordinates
  BlockJacobians wrt;     ///< d target' / d block, the target itself included
  BlockMatrix cov_noise;  ///< covariance added to `target`, tangent coordinates
};

/// z = h(x) + v, v ~ N(0, cov): one measurement, linearized.
struct LinearizedMeasurement {
  MeasurementVector innovation;  ///< z - h(x), angles wrapped
  BlockJacobians wrt;            ///< d h / d block
  MeasurementMatrix cov;         ///< measurement noise R
};

/// A new block x_new = g(x, z): its estimate, derivatives and own noise.
struct Initialization {
  BlockVector estimate;
  BlockJacobians wrt;     ///< d g / d block of the state
  BlockMatrix cov_noise;  ///< G_z R G_z^T
};

}  // namespace libslam
