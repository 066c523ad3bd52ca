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

/// A feature taken for a sighting of a landmark, both by position.
struct Pairing {
  std::size_t feature = 0, landmark = 0;
  bool operator==(const Pairing&) const = default;
};

/// Tests feature-landmark pairs, alone or together; the filter implements it.
class Compatibility {
 public:
  virtual ~Compatibility() = default;
  /// Nothing if the pair is certainly farther apart than `limit` (squared Mahalanobis distance), or
  /// impossible: the sensor could not see the landmark.
  virtual std::optional<Match> test(std::size_t feature, std::size_t landmark, double limit) = 0;

  // Several pairs together. Their innovations nu_i, each with its own noise R_i, are one Gaussian
  // vector, because all depend on one pose: a hypothesis is tested with nu and S of its pairs.

  /// Linearizes `pairs`; what is below numbers them in this order.
  virtual void select(std::span<const Pairing> pairs) = 0;
  virtual const MeasurementVector& innovation(std::size_t pair) const = 0;
  virtual const MeasurementMatrix& noise(std::size_t pair) const = 0;
  /// H_first P H_second^T, plus the noise where both are the same pair.
  virtual MeasurementMatrix covariance(std::size_t first, std::size_t second) const = 0;
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
