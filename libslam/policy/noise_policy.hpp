#pragma once
// Contract of policies that adapt the measurement noise R.
//
// Given   the features of an observation before they are used, and afterwards how those that passed
//         the gate fit the state, before it is corrected,
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
  /// `features`: as the last `apply` left them; `accepted`: those of one joint correction. True:
  /// the noise of this very observation is now believed to be another, which `features` have got;
  /// the caller weighs them anew and observes once more, which replaces what was learned from them.
  virtual bool observe(std::span<Feature> features, std::span<const Postfit> accepted) = 0;
  /// What the policy believes at present; the same names at all times.
  virtual std::vector<AdaptedNoise> noise() const = 0;
};

}  // namespace libslam
