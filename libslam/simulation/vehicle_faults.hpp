#pragma once
// What happens to a vehicle without its odometry noticing.

#include <cstdint>

#include <Eigen/Core>

#include <libslam/simulation/fault_parameters.hpp>

namespace libslam {

class VehicleFaults {
 public:
  VehicleFaults(const FaultParameters& faults, std::uint64_t seed)
      : slip_(faults.slip), kidnap_(faults.kidnap), seed_(seed) {}

  /// True pose at the end of control step `tick`, which ends `elapsed` [s] after the start and took
  /// `dt` [s], where the motion model took the robot from `before` to `after`.
  Eigen::Vector3d disturb(const Eigen::Vector3d& before, const Eigen::Vector3d& after,
                          std::int64_t tick, double elapsed, double dt);

  bool slipping() const { return slip_left_s_ > 0.0; }

 private:
  /// Slips start at random while the wheels grip.
  void advance_slip(std::int64_t tick, double dt);

  SlipParameters slip_;
  KidnapParameters kidnap_;
  std::uint64_t seed_;
  double slip_left_s_ = 0.0;  ///< rest of the slip
  double slip_side_ = 1.0;    ///< +1 left, -1 right
  bool kidnapped_ = false;
};

}  // namespace libslam
