#pragma once
// What all simulated sensors share: where they really sit, and how noisy they really are.

#include <cstdint>
#include <random>

#include <Eigen/Core>
#include <mrpt/poses/CPose3D.h>

#include <libslam/simulation/random_stream.hpp>
#include <libslam/simulation/scenario.hpp>
#include <libslam/simulation/sensor.hpp>

namespace libslam {

/// Pose of a sensor on the robot: x [m], y [m], phi [rad].
struct SensorMount {
  Eigen::Vector3d logged;  ///< what the log says
  Eigen::Vector3d actual;  ///< where it is

  SensorMount(const SensorPoseParameters& pose, const TruthParameters& truth);

  /// `logged` as the log holds it, `height` [m] above the ground.
  mrpt::poses::CPose3D logged_pose(double height = 0.0) const;
};

/// Random numbers of one sensor, with the faults that concern sensors.
class SensorNoise {
 public:
  /// `noise` and `outlier`: the purposes of this sensor.
  SensorNoise(const FaultParameters& faults, std::uint64_t seed, RandomPurpose noise,
              RandomPurpose outlier)
      : faults_(faults), seed_(seed), noise_(noise), outlier_(outlier) {}

  /// Numbers for one entry of an observation; a sensor may share one stream between its entries if
  /// each takes the same amount.
  RandomStream stream(const SensorScene& scene, std::size_t element = 0) const {
    return {seed_, noise_, scene.observation, static_cast<std::uint32_t>(element)};
  }
  RandomStream outlier_stream(const SensorScene& scene, std::size_t element = 0) const {
    return {seed_, outlier_, scene.observation, static_cast<std::uint32_t>(element)};
  }
  /// True if the next measurement of this stream is nonsense.
  bool draw_outlier(RandomStream& stream) const {
    return faults_.outliers.enabled &&
           std::uniform_real_distribution<double>()(stream) < faults_.outliers.fraction;
  }
  bool has_outliers() const { return faults_.outliers.enabled; }

  /// Factor on the nominal standard deviations.
  double factor(double elapsed, double distance) const;

 private:
  FaultParameters faults_;
  std::uint64_t seed_;
  RandomPurpose noise_, outlier_;
};

}  // namespace libslam
