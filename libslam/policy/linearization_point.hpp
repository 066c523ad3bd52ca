#pragma once
// Where derivatives are taken, if not at the estimate.
//
// A shift and a turn of the whole world change no measurement. The filter respects that if the
// direction of the turn, N = (1, J p, J m_1 ... J m_n) for heading, position p and landmarks m_i,
// is in the null space of every measurement Jacobian and carried over by every motion Jacobian.
// Both hold if derivatives are taken along one consistent history of points: every m_i fixed, and p
// moving in a step by exactly what the motion Jacobian says. Where the point of linearization of a
// position moves by `jump` beyond that, the covariance has to follow it,
//     P <- C P C^T,   C = I + u e_heading^T,   u = J jump at that position,  0 elsewhere,
// which is what these policies return. With C = I instead, the textbook EKF, N turns from step to
// step and information about the heading appears out of nothing.
// Source: Huang, Mourikis & Roumeliotis, "Observability-based rules for designing consistent EKF
// SLAM estimators", IJRR 29(5), 2010: Phi = [I, J (p_(k+1|k) - p_(k|k-1)); 0 1] is F C. Predictions
// and innovations are always those of the estimate.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <libslam/state/block.hpp>

namespace libslam {

/// The points belong to planar positions: one SE(2) pose and two-dimensional landmarks.
class LinearizationPoint {
 public:
  virtual ~LinearizationPoint() = default;

  /// The state has got its pose or a calibration parameter.
  virtual void add_block(BlockId block, const BlockSpec& spec) = 0;
  /// A landmark has been added at `reached`, where its first sighting puts it as seen from the
  /// pose of linearization. Returns the jump from there to its point of linearization [m].
  virtual Eigen::Vector2d add_landmark(BlockId block, std::int64_t identity,
                                       const Eigen::Vector2d& reached) = 0;
  /// Value (storage) at which derivatives with respect to `block` are taken; null: its estimate.
  virtual const BlockVector* find(BlockId block) const = 0;
  /// The robot has moved; `reached` is where the motion takes the point of linearization. Returns
  /// the jump from there to the next one.
  virtual Eigen::Vector2d move(const Eigen::Vector2d& reached) = 0;
  /// A correction has moved the estimate of the position. Returns the jump of its point.
  virtual Eigen::Vector2d correct(const Eigen::Vector2d& before, const Eigen::Vector2d& after) = 0;
};

/// Landmarks at their first estimates, the pose at its prediction: first-estimates Jacobians. A bad
/// first estimate of a landmark stays in all later derivatives.
class FirstEstimates final : public LinearizationPoint {
 public:
  void add_block(BlockId, const BlockSpec&) override {}
  Eigen::Vector2d add_landmark(BlockId block, std::int64_t identity,
                               const Eigen::Vector2d& reached) override;
  const BlockVector* find(BlockId block) const override;
  Eigen::Vector2d move(const Eigen::Vector2d&) override { return Eigen::Vector2d::Zero(); }
  Eigen::Vector2d correct(const Eigen::Vector2d& before, const Eigen::Vector2d& after) override {
    return after - before;
  }

 private:
  std::map<BlockId, BlockVector> first_;
};

/// What a simulation knows, in the world frame of the filter.
struct TrueState {
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< at the end of the step that comes next
  std::map<std::int64_t, Eigen::Vector2d> landmarks;
  std::map<std::string, double> calibration;
};

/// Everything at the truth: the ideal filter of consistency studies, which no robot can run. What
/// the simulation does not know (a landmark, a parameter) is taken at the estimate.
class TruthPoint final : public LinearizationPoint {
 public:
  /// `truth` starts with the pose before the first step, is moved on by the caller before every
  /// step, and outlives the filter.
  explicit TruthPoint(const TrueState& truth);
  void add_block(BlockId block, const BlockSpec& spec) override;
  Eigen::Vector2d add_landmark(BlockId block, std::int64_t identity,
                               const Eigen::Vector2d& reached) override;
  const BlockVector* find(BlockId block) const override;
  Eigen::Vector2d move(const Eigen::Vector2d& reached) override;
  Eigen::Vector2d correct(const Eigen::Vector2d&, const Eigen::Vector2d&) override {
    return Eigen::Vector2d::Zero();
  }

 private:
  const TrueState& truth_;
  BlockId pose_;
  std::map<BlockId, BlockVector> points_;
};

}  // namespace libslam
