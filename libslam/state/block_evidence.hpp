#pragma once
// What a correction said about one block of the state.

#include <libslam/state/block.hpp>

namespace libslam {

/// With H the columns of the block: both in its tangent coordinates before the correction.
struct BlockEvidence {
  TangentVector score;      ///< H^T S^-1 nu
  BlockMatrix information;  ///< H^T S^-1 H
};

}  // namespace libslam
