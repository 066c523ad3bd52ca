#pragma once
// Counter-based random numbers: what is drawn depends on its purpose, step and element alone, never
// on what was drawn before.
//
// Philox 4x32-10 of Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3",
// SC 2011.

#include <array>
#include <cstdint>
#include <limits>

namespace libslam {

/// What random numbers are drawn for; each purpose has its own, independent ones.
enum class RandomPurpose : std::uint32_t {
  kMotion,
  kWorld,
  kRangeBearing,
  kRangeBearingOutlier,
  kBeacons,
  kBeaconsOutlier,
  kLaser,
  kLaserOutlier,
  kStereo,
  kStereoOutlier,
  kSlip,
  kMovingLandmarks,
  kStereoImages,
};

/// A generator for the distributions of <random>, of one purpose, step and element.
class RandomStream {
 public:
  using result_type = std::uint64_t;

  RandomStream(std::uint64_t seed, RandomPurpose purpose, std::uint64_t step = 0,
               std::uint32_t element = 0);

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()();

 private:
  using Counter = std::array<std::uint32_t, 4>;
  using Key = std::array<std::uint32_t, 2>;

  void refill();

  Key key_;
  Counter counter_;  ///< block, element, step, purpose with the high bits of step
  Counter block_{};
  unsigned used_ = 4;
};

}  // namespace libslam
