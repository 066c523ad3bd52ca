#pragma once
// Contract of policies that adapt the measurement noise R.
//
// Given   the features of an observation before they are used, and afterwards what the correction
//         left behind of those that passed the gate,
// Then    `apply` replaces the covariance of each feature by what the policy believes, and
//         `observe` learns; neither sees the state, and rejected innovations never reach it. The
//         caller may leave `observe` out: nothing is learned from that observation.

#include <span>
#include <vector>

#include <libslam/data/feature.hpp>
#include <libslam/data/postfit.hpp>
#include <libslam/data/step_record.hpp>

namespace libslam {

class NoisePolicy {
 public:
  virtual ~NoisePolicy() = default;
  /// Remembers what it needs to learn from these features.
  virtual void apply(std::span<Feature> features) = 0;
  /// `features`: as the last `apply` left them; `corrected`: those used in one joint correction.
  virtual void observe(std::span<const Feature> features, std::span<const Postfit> corrected) = 0;
  /// What the policy believes at present; the same names at all times.
  virtual std::vector<AdaptedNoise> noise() const = 0;
};

}  // namespace libslam
