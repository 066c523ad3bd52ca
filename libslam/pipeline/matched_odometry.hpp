#pragma once
// Odometry of which the increments are refined by matching laser scans.
//
// A small filter beside the large one holds the pose of the robot relative to a reference scan, and
// three errors of the wheels (scale_speed, scale_turn, bias_turn of motion/odometry_increment.hpp),
// which it learns from the matches: without them the odometry would pull at every match. Since the
// reference,
//
//   1. the odometry moves the pose, with the noise of `motion.noise`;
//   2. a scan gives the pose by its match (frontend/scan_matching.hpp); the product of both
//      Gaussians counts. Along a corridor the match says nothing, and the odometry keeps its say. A
//      match that contradicts the odometry (chi-square, 99.9 %) means that the wheels slipped: the
//      covariance of the odometry is widened for it, and the wheels learn nothing;
//   3. where the robot is far enough away, the scan becomes the new reference.
//
// All scans of one reference are matched with the same points, and to all of them belongs the same
// odometry, so step 2 never builds on an earlier match: the pose that it corrects is always that of
// the odometry from the reference on. What is handed on are the increments between the corrected
// poses. Their errors are not independent; the covariances are chosen such that those handed on so
// far add up to C_k, the covariance of the pose k since the reference: Q_k is the positive part of
// C_k - F (Q_1 + ... + Q_k-1) F^T. Only the first increment after a reference has the whole
// uncertainty of a match, and a robot at rest gains none.

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include <Eigen/Core>

#include <libslam/config/parameters.hpp>
#include <libslam/data/log_step.hpp>
#include <libslam/data/motion_action.hpp>
#include <libslam/filter/ekf.hpp>
#include <libslam/frontend/scan_matching.hpp>
#include <libslam/motion/motion_model.hpp>

namespace libslam {

class MatchedOdometry {
 public:
  /// Uses the first level scan of a frame that is labelled `input.sensor_label`; empty: any.
  explicit MatchedOdometry(const Parameters& parameters);

  /// Replaces increment and covariance of `action`, the odometry of `step`.
  void refine(const LogStep& step, MotionAction& action);
  /// The robot has moved without odometry: the next scan is a new reference.
  void restart() { referenced_ = false; }

  /// matches, matches_failed, slips, match_iterations (mean), and the errors of the wheels:
  /// odometry_scale_speed, odometry_scale_turn [1], odometry_bias_turn [rad/m].
  std::map<std::string, double> figures() const;

 private:
  /// True if the current scan of the matcher is that of `step`.
  bool look(const LogStep& step);
  /// Moves the pose since the reference; returns the increment, the errors of the wheels corrected.
  Eigen::Vector3d move(const MotionAction& action);
  /// Fills matched_ from state_ and the current scan; false if they do not match.
  bool match();
  void fill_measurement(const ScanMatch& match);
  void widen_pose(double factor);
  /// Hands on the way to `pose`, of which the errors since the reference have covariance `cov`.
  void hand_on(const Eigen::Vector3d& pose, const Eigen::Matrix3d& cov, MotionAction& action);
  void hand_on_unmatched(const Eigen::Vector3d& increment, MotionAction& action);
  bool is_far(const Eigen::Vector3d& pose) const;
  void renew_reference(bool learned);
  void place_at_reference();

  ScanMatcher matcher_;
  std::string sensor_label_;
  double distance_, turn_;
  std::unique_ptr<MotionModel> wheels_;
  Ekf ekf_;
  GaussianState state_, matched_;  // by odometry since the reference; with the last match
  BlockId pose_;
  CalibrationBlocks errors_;
  MotionStep motion_step_;
  LinearizedMeasurement measurement_;
  bool referenced_ = false, slipped_ = false;
  Eigen::Vector3d T_reference_robot_ = Eigen::Vector3d::Zero();  // as handed on
  Eigen::Matrix3d cov_handed_on_ = Eigen::Matrix3d::Zero();
  std::int64_t matches_ = 0, failed_ = 0, slips_ = 0, iterations_ = 0;
};

}  // namespace libslam
