#pragma once
// Association by what features look like, confirmed by where they are.

#include <utility>
#include <vector>

#include <libslam/association/associator.hpp>

namespace libslam {

/// A feature belongs to the landmark whose descriptor is nearest, if it is near and clearly nearer
/// than any other landmark's (ratio test: Lowe, IJCV 2004), and if the place fits too. Where the
/// place does not fit, the feature is gated: something moved, or looks alike. Two features that
/// claim one landmark: the nearer has it, the other is ambiguous. A feature that resembles no
/// landmark is new; one that resembles several, or has no descriptor, is ambiguous.
class AppearanceAssociation final : public Associator {
 public:
  /// `gate`: largest squared Mahalanobis distance; `max_distance`: largest relative_distance of
  /// descriptors; `ratio`: best over second best distance, at most. Throws std::invalid_argument
  /// unless gate > 0 and the others are in (0, 1].
  AppearanceAssociation(double gate, double max_distance, double ratio);
  void associate(std::span<const Feature> features, const LandmarkRegistry& registry,
                 Compatibility& compatibility, std::vector<Verdict>& verdicts) override;

 private:
  struct Claim {
    double distance;
    std::size_t feature, landmark;
  };
  /// The verdict by appearance alone; kPaired where there is one clear landmark, which then stands
  /// in `claims_`.
  Outcome look_up(std::size_t feature, const Descriptor& appearance,
                  const LandmarkRegistry& registry);

  double gate_, max_distance_, ratio_;
  std::vector<Claim> claims_;
  std::vector<bool> taken_;  // landmarks
};

}  // namespace libslam
