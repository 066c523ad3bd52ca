#pragma once
// Tests feature-landmark pairs against the state of the filter.

#include <cstddef>
#include <optional>
#include <span>

#include <libslam/association/associator.hpp>
#include <libslam/association/landmark_registry.hpp>
#include <libslam/filter/ekf.hpp>
#include <libslam/filter/linearizer.hpp>
#include <libslam/filter/selected_pairs.hpp>
#include <libslam/measurement/measurement_model.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

/// What a filter lends to the test of its pairs; all of it outlives the test.
struct PairTestParts {
  GaussianState& state;  ///< the same before and after a test
  BlockId pose;
  Ekf& ekf;
  Linearizer& linearizer;
  const MeasurementModel& measurement;
  const LandmarkRegistry& registry;
  SelectedPairs& selected;  ///< memory of the joint test
  double extent_gap;        ///< farthest that two parts of one line lie apart [m]
};

/// Innovations of the pairs of one observation, with a cheap bound that skips pairs far apart.
class PairTest final : public Compatibility {
 public:
  PairTest(const PairTestParts& parts, std::span<const Feature> features)
      : parts_(parts), features_(features) {}

  std::optional<Match> test(std::size_t feature, std::size_t landmark, double limit) override;
  void select(std::span<const Pairing> pairs) override;
  const MeasurementVector& innovation(std::size_t pair) const override {
    return parts_.selected.innovation(pair);
  }
  const MeasurementMatrix& noise(std::size_t pair) const override {
    return parts_.selected.noise(pair);
  }
  MeasurementMatrix covariance(std::size_t first, std::size_t second) const override {
    return parts_.selected.covariance(first, second);
  }

 private:
  bool apart_along(std::size_t feature, const RegisteredLandmark& landmark) const;
  bool far_apart(std::size_t feature, BlockId landmark, double limit);

  PairTestParts parts_;
  std::span<const Feature> features_;
  LinearizedMeasurement measurement_;
  Initialization where_;
  std::size_t prepared_ = static_cast<std::size_t>(-1);
  double trace_ = 0.0;
};

}  // namespace libslam
