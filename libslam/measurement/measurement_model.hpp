#pragma once
// Contract of measurement models of landmarks.
//
// Given   a state with a pose block and a landmark block, and a feature in the sensor frame,
// Then    `linearize` returns innovation (angles wrapped), derivatives and noise in the additive
//         chart; the innovation is NaN where the sensor cannot see the landmark at all, and such a
//         pair is never used;
//         `initialize` returns the landmark that explains an `initializable` feature exactly, with
//         derivatives.

#include <libslam/data/feature.hpp>
#include <libslam/state/gaussian_state.hpp>
#include <libslam/state/linearization.hpp>

namespace libslam {

class MeasurementModel {
 public:
  virtual ~MeasurementModel() = default;

  /// The block a landmark of this model occupies (its name is filled in by the caller).
  virtual BlockSpec landmark_spec() const = 0;
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
};

}  // namespace libslam
