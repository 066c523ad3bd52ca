#pragma once
// What the odometry of a simulated vehicle says: motions as MRPT logs carry them.

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include <Eigen/Core>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/system/datetime.h>

#include <libslam/data/motion_action.hpp>
#include <libslam/motion/motion_model.hpp>
#include <libslam/simulation/scenario.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

/// Three views of one vehicle, the same motion model three times.
struct SimulatedVehicle {
  std::unique_ptr<MotionModel>
      commanded;                        ///< nominal, driven by velocities: commands to increments
  std::unique_ptr<MotionModel> logged;  ///< nominal, driven by `log.odometry`: its covariance
  std::unique_ptr<MotionModel> actual;  ///< true calibration, driven by `log.odometry`
};

/// Calibration of the real vehicle as constants of a motion model.
CalibrationParameters calibration_of(const TruthParameters& truth);

/// True values of the parameters that the motion model has (Simulator::calibration).
std::map<std::string, double> true_calibration(const Scenario& scenario);

/// Turns commands into actions and gathers them until they are taken.
///
/// Each action carries the increment of the nominal model, its covariance with the noise of
/// `motion.noise`, and with `log.odometry` velocities or ticks also that field. Ticks are the
/// rounded running total of nominal wheel travel; the increment beside them is the one that they
/// give. Several commands in one action: increments and covariances are composed, ticks are added,
/// velocities averaged.
class OdometryLog {
 public:
  OdometryLog(const Scenario& scenario, const SimulatedVehicle& vehicle);

  /// A command (v [m/s], omega [rad/s]) during `dt` [s] up to `time` [s], as the log tells it to a
  /// motion model; its covariance is in the log alone.
  MotionAction add(const Eigen::Vector2d& command, double time, double dt);

  /// All that was added since the last take, with the stamp of its end.
  mrpt::obs::CActionCollection::Ptr take(mrpt::system::TTimeStamp stamp);
  /// True if what was taken last carries a covariance that is not zero.
  bool has_covariance() const { return has_covariance_; }

 private:
  struct Gathered {
    double duration = 0.0;
    Eigen::Vector3d increment = Eigen::Vector3d::Zero();
    Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();
    Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
    Eigen::Vector2d ticks = Eigen::Vector2d::Zero();
  };

  Eigen::Vector2d count_ticks(const Eigen::Vector2d& movement);
  Eigen::Vector2d movement_of_ticks(const Eigen::Vector2d& ticks, double turn) const;
  void gather(const MotionAction& action, const Eigen::Matrix3d& cov);
  MotionStep linearize(const MotionModel& model, const MotionAction& action) const;

  const MotionModel& commanded_;
  const MotionModel& logged_;
  bool with_velocities_, with_ticks_;
  bool turns_by_wheels_;  ///< differential: the wheels differ where the robot turns
  double track_width_;
  Eigen::Vector2d metres_per_tick_;
  GaussianState origin_;  ///< a pose at zero
  BlockId pose_;
  Eigen::Vector2d wheel_travel_ = Eigen::Vector2d::Zero();  ///< nominal, since the start [m]
  Eigen::Vector2d counted_ = Eigen::Vector2d::Zero();       ///< ticks since the start
  Gathered gathered_;
  bool has_covariance_ = false;
};

}  // namespace libslam
