#pragma once
// Whether the motion excites a calibration parameter.
//
// A scale factor multiplies a *measured* motion. Where the measured motion is mostly noise (the
// turn of a robot that drives straight), regression on it is biased towards zero (errors in
// variables), and a filter would pull the factor away from its prior although the data say nothing
// about it. The monitor compares, over windows of about a second, the motion that the parameter
// scales with the odometry noise in it, both whitened:  snr = (c J)^T Q^-1 (c J),  J the summed
// body-frame derivative of the pose with respect to the parameter, c its nominal value, Q the
// summed process noise. While the running mean of snr is below `kThreshold` the filter considers
// the parameter (Schmidt-Kalman) instead of estimating it: its uncertainty counts, its estimate and
// covariance stay.

#include <span>
#include <vector>

#include <Eigen/Core>

namespace libslam {

class Excitation {
 public:
  /// Mean snr of pure noise is at most the rank of J Q^-1/2, that is 1 for a parameter of one
  /// motion direction; four times that is beyond chance over the averaging length.
  static constexpr double kThreshold = 4.0;
  static constexpr double kWindow = 1.0;       ///< length of a window [s]; without times, one step
  static constexpr double kForgetting = 0.95;  ///< weight of the past per window

  /// `nominal`: scale c of each parameter.
  explicit Excitation(std::vector<double> nominal);

  /// Adds one motion step: columns of J (3 x parameters) and Q in the robot frame.
  void observe(const Eigen::Ref<const Eigen::Matrix3Xd>& jacobian, const Eigen::Matrix3d& noise,
               double dt);
  bool excited(std::size_t parameter) const { return excited_[parameter]; }
  /// Excited at any time so far.
  bool ever_excited(std::size_t parameter) const { return ever_excited_[parameter]; }

  /// All that has been observed, as numbers for a file.
  std::vector<double> memory() const;
  /// Goes on from `memory` of a monitor of as many parameters. Throws std::invalid_argument if it
  /// has another length.
  void remember(std::span<const double> memory);

 private:
  void close_window();

  std::vector<double> nominal_;
  Eigen::Matrix3Xd jacobian_;
  Eigen::Matrix3d noise_ = Eigen::Matrix3d::Zero();
  double elapsed_ = 0.0;
  Eigen::VectorXd mean_snr_;
  std::vector<bool> excited_, ever_excited_;
};

}  // namespace libslam
