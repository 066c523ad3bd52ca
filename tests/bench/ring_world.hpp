#pragma once
// A synthetic world whose steps cost the same for ever: landmarks on a ring, a robot that drives
// laps.

#include <vector>

#include <Eigen/Core>

#include <libslam/data/feature.hpp>
#include <libslam/data/log_step.hpp>
#include <libslam/data/motion_action.hpp>
#include <libslam/frontend/frontend.hpp>

namespace libslam::bench {

/// One step in the form that MRPT takes and in the form that `EkfSlam` takes, made from it.
struct RingStep {
  LogStep log;
  MotionAction action;
  FeatureBatch features;
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();  ///< pose in the frame of step 0
};

/// The robot passes `kAdvance` landmarks per step and sees the `kSeen` nearest ones, with
/// identities and Gaussian noise. The last step ends one advance before the first, so the lap can
/// be repeated.
struct RingWorld {
  static constexpr int kSeen = 10;
  static constexpr int kAdvance = 5;
  static constexpr double kSigmaRange = 0.01;     ///< [m]
  static constexpr double kSigmaBearing = 0.001;  ///< [rad]

  /// `landmarks` is a multiple of kAdvance, at least 2 * kSeen; the same number gives the same
  /// world.
  explicit RingWorld(int landmarks);

  std::vector<RingStep> lap;
};

/// The world with that many landmarks, made once.
const RingWorld& ring_world(int landmarks);

}  // namespace libslam::bench
