#pragma once
// Contract of policies that adapt the measurement noise R.
//
// Given   the features of an observation before they are used, and afterwards what the correction
//         left behind of those that passed the gate,
// Then    `apply` replaces the covariance of each feature by what the policy believes, and
//         `observe` learns; neither sees the state, and rejected innovations never reach it.

#include <span>

#include <libslam/data/feature.hpp>
#include <libslam/data/postfit.hpp>

namespace libslam {

class NoisePolicy {
 public:
  virtual ~NoisePolicy() = default;
  virtual void apply(std::span<Feature> features) const = 0;
  /// `features`: as `apply` left them; `corrected`: those used in one joint correction.
  virtual void observe(std::span<const Feature> features, std::span<const Postfit> corrected) = 0;
};

}  // namespace libslam
