#pragma once
// Contract of data association.
//
// Given   the features of one observation, the landmarks of the map and a way to test a pair,
// Then    every feature gets one verdict, and no landmark is paired with two features.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <libslam/association/landmark_registry.hpp>
#include <libslam/data/feature.hpp>

namespace libslam {

/// How well a feature fits a landmark.
struct Match {
  double mahalanobis2 = 0.0;  ///< squared Mahalanobis distance of the innovation
  double log_det = 0.0;       ///< log |S|: prefers the better known of two equally near landmarks
};

/// Tests feature-landmark pairs; the filter implements it.
class Compatibility {
 public:
  virtual ~Compatibility() = default;
  /// Nothing if the pair is certainly farther apart than `limit` (squared Mahalanobis distance), or
  /// impossible: the sensor could not see the landmark.
  virtual std::optional<Match> test(std::size_t feature, std::size_t landmark, double limit) = 0;
};

enum class Outcome {
  kPaired,     ///< a sighting of a landmark
  kGated,      ///< has a partner by identity, but does not fit it
  kAmbiguous,  ///< neither a sighting nor clearly new: not used
  kNew,        ///< the first sighting of a landmark
};

struct Verdict {
  Outcome outcome = Outcome::kAmbiguous;
  std::size_t landmark = 0;  ///< position in the registry, for kPaired and kGated
};

class Associator {
 public:
  virtual ~Associator() = default;
  /// `verdicts` is resized to one per feature.
  virtual void associate(std::span<const Feature> features, const LandmarkRegistry& registry,
                         Compatibility& compatibility, std::vector<Verdict>& verdicts) = 0;
};

}  // namespace libslam
