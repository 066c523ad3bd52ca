#pragma once
// For tests of associators that ask about single pairs only.

#include <libslam/association/associator.hpp>

namespace libslam::testing {

/// No joint tests.
class PairwiseCompatibility : public Compatibility {
 public:
  void select(std::span<const Pairing>) override {}
  const MeasurementVector& innovation(std::size_t) const override { return none_; }
  const MeasurementMatrix& noise(std::size_t) const override { return no_noise_; }
  MeasurementMatrix covariance(std::size_t, std::size_t) const override { return no_noise_; }

 private:
  MeasurementVector none_;
  MeasurementMatrix no_noise_;
};

}  // namespace libslam::testing
