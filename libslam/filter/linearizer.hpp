#pragma once
// Models, linearized at the estimate or where a policy says. Models are unaware of it: their
// predictions come from one call at the estimate, their derivatives from a second one elsewhere.

#include <cstdint>
#include <memory>

#include <Eigen/Core>

#include <libslam/measurement/measurement_model.hpp>
#include <libslam/motion/motion_model.hpp>
#include <libslam/policy/linearization_point.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

class Linearizer {
 public:
  /// Null: everything at the estimate, at no cost.
  explicit Linearizer(std::unique_ptr<LinearizationPoint> point) : point_(std::move(point)) {}

  /// Throws std::invalid_argument if a point of linearization is not derived for `landmark`.
  void require_supported(const BlockSpec& landmark) const;
  void add_block(const GaussianState& state, BlockId block);

  // Each fills the last argument like the method of the model of the same name; the estimates in
  // `state` are the same before and after.
  void linearize(const MotionModel& model, GaussianState& state, BlockId pose,
                 const CalibrationBlocks& blocks, const MotionAction& action, MotionStep& step);
  void linearize(const MeasurementModel& model, GaussianState& state, BlockId pose,
                 BlockId landmark, const Feature& feature, LinearizedMeasurement& out);
  void initialize(const MeasurementModel& model, GaussianState& state, BlockId pose,
                  const Feature& feature, Initialization& out);

  // To be called after what was linearized has reached the state; `stood`: a step without motion.
  void moved(GaussianState& state, BlockId pose);
  void stood(GaussianState& state, BlockId pose);
  void corrected(GaussianState& state, BlockId pose, const Eigen::Vector2d& before);
  void added(GaussianState& state, BlockId pose, BlockId landmark, std::int64_t identity);

 private:
  /// P follows the point of linearization of `block`, which jumped.
  void follow(GaussianState& state, BlockId pose, BlockId block, const Eigen::Vector2d& jump);

  std::unique_ptr<LinearizationPoint> point_;
  MotionStep step_;
  LinearizedMeasurement measurement_;
  Initialization initialization_;
  Eigen::Vector2d reached_ = Eigen::Vector2d::Zero();
  Eigen::VectorXd u_;
};

}  // namespace libslam
