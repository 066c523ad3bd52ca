#include <cmath>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <libslam/simulation/odometry_log.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

namespace {

CalibrationParameter constant(double value) {
  CalibrationParameter parameter;
  parameter.prior_mean = value;
  return parameter;
}

Eigen::Matrix3d turn_planar(double angle) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(angle).toRotationMatrix();
  return rotation;
}

}  // namespace

CalibrationParameters calibration_of(const TruthParameters& truth) {
  CalibrationParameters calibration;
  calibration.scale_left = constant(truth.scale_left);
  calibration.scale_right = constant(truth.scale_right);
  calibration.track_width = constant(truth.track_width);
  calibration.scale_speed = constant(truth.scale_speed);
  calibration.scale_steering = constant(truth.scale_steering);
  calibration.bias_steering = constant(to_radians(truth.bias_steering_deg));
  return calibration;
}

std::map<std::string, double> true_calibration(const Scenario& scenario) {
  const TruthParameters& t = scenario.truth;
  if (scenario.motion.model == "differential")
    return {{"scale_left", t.scale_left},
            {"scale_right", t.scale_right},
            {"track_width", t.track_width}};
  if (scenario.motion.model == "ackermann")
    return {{"scale_left", t.scale_left * t.scale_speed},
            {"scale_right", t.scale_right * t.scale_speed},
            {"scale_speed", t.scale_speed * (t.scale_left + t.scale_right) / 2},
            {"scale_steering", t.scale_steering},
            {"bias_steering", to_radians(t.bias_steering_deg)}};
  return {};
}

OdometryLog::OdometryLog(const Scenario& scenario, const SimulatedVehicle& vehicle)
    : commanded_(*vehicle.commanded),
      logged_(*vehicle.logged),
      with_velocities_(scenario.log.odometry == "velocities"),
      with_ticks_(scenario.log.odometry == "ticks"),
      turns_by_wheels_(scenario.motion.model == "differential"),
      track_width_(scenario.motion.track_width),
      metres_per_tick_(scenario.motion.metres_per_tick_left, scenario.motion.metres_per_tick_right),
      pose_(origin_.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, Eigen::Vector3d::Zero(),
                        Eigen::Matrix3d::Zero())) {}

MotionStep OdometryLog::linearize(const MotionModel& model, const MotionAction& action) const {
  MotionStep step;
  model.linearize(origin_, pose_, {}, action, step);
  return step;
}

Eigen::Vector2d OdometryLog::count_ticks(const Eigen::Vector2d& movement) {
  const double half = turns_by_wheels_ ? movement.y() * track_width_ / 2 : 0.0;
  wheel_travel_ += Eigen::Vector2d(movement.x() - half, movement.x() + half);
  const Eigen::Vector2d total = wheel_travel_.cwiseQuotient(metres_per_tick_).array().round();
  const Eigen::Vector2d ticks = total - counted_;
  counted_ = total;
  return ticks;
}

Eigen::Vector2d OdometryLog::movement_of_ticks(const Eigen::Vector2d& ticks, double turn) const {
  const Eigen::Vector2d wheels = metres_per_tick_.cwiseProduct(ticks);
  return {wheels.mean(), turns_by_wheels_ ? (wheels.y() - wheels.x()) / track_width_ : turn};
}

MotionAction OdometryLog::add(const Eigen::Vector2d& command, double time, double dt) {
  MotionAction action;
  action.time = time;
  action.dt = dt;
  action.velocity = command;
  if (with_ticks_) {
    action.ticks = count_ticks(command * dt);
    action.velocity = movement_of_ticks(*action.ticks, command.y() * dt) / dt;
  }
  action.increment = linearize(commanded_, action).estimate;
  if (!with_velocities_) action.velocity.reset();
  gather(action, linearize(logged_, action).cov_noise);
  return action;
}

void OdometryLog::gather(const MotionAction& action, const Eigen::Matrix3d& cov) {
  Gathered& g = gathered_;
  const Eigen::Matrix3d rotation = turn_planar(g.increment.z());
  const Eigen::Vector3d moved = rotation * action.increment;
  Eigen::Matrix3d wrt_before = Eigen::Matrix3d::Identity();
  wrt_before(0, 2) = -moved.y();
  wrt_before(1, 2) = moved.x();
  g.cov = wrt_before * g.cov * wrt_before.transpose() + rotation * cov * rotation.transpose();
  g.increment = compose_poses(g.increment, action.increment);
  if (action.ticks) g.ticks += *action.ticks;
  if (action.velocity)  // a lone velocity stays as it is, bit for bit
    g.velocity += (*action.velocity - g.velocity) * (action.dt / (g.duration + action.dt));
  g.duration += action.dt;
}

mrpt::obs::CActionCollection::Ptr OdometryLog::take(mrpt::system::TTimeStamp stamp) {
  mrpt::obs::CActionRobotMovement2D motion;
  motion.timestamp = stamp;
  const Eigen::Vector3d& d = gathered_.increment;
  motion.rawOdometryIncrementReading = {d.x(), d.y(), d.z()};
  mrpt::math::CMatrixDouble33 cov;
  cov.asEigen() = gathered_.cov.selfadjointView<Eigen::Upper>();  // a file keeps the upper triangle
  has_covariance_ = !cov.asEigen().isZero(0.0);
  motion.poseChange =
      mrpt::poses::CPosePDFGaussian::Create(motion.rawOdometryIncrementReading, cov);
  // MRPT recomputes poseChange from its own motion model when it reads an action of method
  // odometry.
  motion.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  motion.hasVelocities = with_velocities_;
  if (with_velocities_)
    motion.velocityLocal = {gathered_.velocity.x(), 0.0, gathered_.velocity.y()};
  motion.hasEncodersInfo = with_ticks_;
  motion.encoderLeftTicks = static_cast<std::int32_t>(gathered_.ticks.x());
  motion.encoderRightTicks = static_cast<std::int32_t>(gathered_.ticks.y());
  gathered_ = {};
  auto actions = mrpt::obs::CActionCollection::Create();
  actions->insert(motion);
  return actions;
}

}  // namespace libslam
