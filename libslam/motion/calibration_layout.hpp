#pragma once
// Which odometry parameters are states and which are constants.

#include <initializer_list>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <libslam/config/parameters.hpp>
#include <libslam/motion/motion_model.hpp>

namespace libslam {

/// Every calibration parameter there is, in the order of `CalibrationVector`.
enum CalibrationIndex : Eigen::Index {
  kScaleLeft,      ///< true travel of the left wheel per nominal travel [1]
  kScaleRight,     ///< the same of the right wheel [1]
  kTrackWidth,     ///< true track width per nominal track width [1]
  kScaleSpeed,     ///< true speed per nominal speed [1]
  kScaleSteering,  ///< true steering angle per nominal angle [1]
  kBiasSteering,   ///< added to the scaled steering angle [rad]
  kScaleTurn,      ///< true turn per turn of the odometry [1]
  kBiasTurn,       ///< turn per metre that the odometry does not see [rad/m]
  kCalibrationCount
};

/// The values of all parameters, constants and states alike.
using CalibrationVector = Eigen::Matrix<double, kCalibrationCount, 1>;

/// The parameters that one model estimates. A parameter that is not enabled is a constant with the
/// value of its `prior_mean`.
class CalibrationLayout {
 public:
  /// Throws std::invalid_argument naming the parameter if one is enabled that is not in
  /// `supported`: the model cannot observe it.
  CalibrationLayout(const CalibrationParameters& parameters,
                    std::initializer_list<CalibrationIndex> supported, std::string_view model);

  /// The enabled parameters, in the order of their blocks.
  const std::vector<CalibrationSpec>& specs() const { return specs_; }
  /// For each enabled parameter its place in a CalibrationVector.
  const std::vector<CalibrationIndex>& indices() const { return indices_; }
  /// Prior means of all parameters.
  const CalibrationVector& priors() const { return priors_; }
  bool enabled(CalibrationIndex index) const;

 private:
  std::vector<CalibrationSpec> specs_;
  std::vector<CalibrationIndex> indices_;
  CalibrationVector priors_;
};

}  // namespace libslam
