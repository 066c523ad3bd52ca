#pragma once
// Contract of measurement models of landmarks.
//
// Given   a state with a pose block and a landmark block, and a feature in the sensor frame,
// Then    `linearize` returns innovation (angles wrapped), derivatives and noise in the additive
//         chart; the innovation is NaN where the sensor cannot see the landmark at all, and such a
//         pair is never used;
//         `initialize` returns the landmark that explains an `initializable` feature exactly, with
//         derivatives.

#include <optional>
#include <string_view>

#include <libslam/data/feature.hpp>
#include <libslam/state/gaussian_state.hpp>
#include <libslam/state/linearization.hpp>

namespace libslam {

/// A landmark with all that was seen of it, in its own frame.
struct LandmarkPart {
  BlockId block;
  Extent extent;
};

class MeasurementModel {
 public:
  virtual ~MeasurementModel() = default;

  /// The block a landmark of this model occupies (its name is filled in by the caller).
  virtual BlockSpec landmark_spec() const = 0;
  /// What map.csv calls such a landmark.
  virtual std::string_view landmark_type() const { return "point"; }
  /// h(x): the measurement that the estimates predict, for the sensor of `feature`.
  virtual MeasurementVector predict(const GaussianState& state, BlockId pose, BlockId landmark,
                                    const Feature& feature) const = 0;
  virtual void linearize(const GaussianState& state, BlockId pose, BlockId landmark,
                         const Feature& feature, LinearizedMeasurement& out) const = 0;
  /// Whether a landmark can start at `feature`: its place is known well enough for a Gaussian.
  virtual bool initializable(const Feature&) const { return true; }
  /// Whether distances between landmarks bound the distance of a feature from a landmark
  /// (filter/pair_test.hpp). Not so where the place that a feature points at is far from Gaussian.
  virtual bool bounded_in_map() const { return true; }
  virtual void initialize(const GaussianState& state, BlockId pose, const Feature& feature,
                          Initialization& out) const = 0;
  /// Which part of a landmark with an extent the feature would show, if it is a sighting of it.
  /// Nothing where landmarks have none.
  virtual std::optional<Extent> sighted_part(const GaussianState&, BlockId /*pose*/,
                                             BlockId /*landmark*/, const Feature&) const {
    return std::nullopt;
  }

  // For models whose landmarks may turn out to be one.

  /// a - b as a measurement of zero, if both may be one landmark; false if they certainly are two,
  /// or of a model that does not merge. `extent_gap`: farthest that parts of one lie apart [m].
  virtual bool difference(const GaussianState&, const LandmarkPart& /*a*/,
                          const LandmarkPart& /*b*/, double /*extent_gap*/,
                          LinearizedMeasurement& /*out*/) const {
    return false;
  }
  /// The extent of `part`, told along another landmark.
  virtual std::optional<Extent> part_along(const GaussianState&, BlockId /*landmark*/,
                                           const LandmarkPart& /*part*/) const {
    return std::nullopt;
  }
};

}  // namespace libslam
