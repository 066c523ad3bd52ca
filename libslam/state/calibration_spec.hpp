#pragma once
// A calibration parameter as models declare it and as it lives in the state.

#include <string>
#include <vector>

#include <libslam/state/block.hpp>

namespace libslam {

/// A calibration parameter as a block of the state.
struct CalibrationSpec {
  std::string name;  ///< block name, e.g. "scale_left"
  double prior_mean = 1.0;
  double prior_sigma = 0.0;  ///< standard deviation of the prior, > 0
  double random_walk = 0.0;  ///< standard deviation per sqrt(second)
  bool additive = false;     ///< an offset of an input (a bias): every motion shows it
};

/// The calibration blocks of a model inside a state, in the order of its `calibration()`.
using CalibrationBlocks = std::vector<BlockId>;

}  // namespace libslam
