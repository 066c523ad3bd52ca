#pragma once
// Does an observation ask for a motion that the odometry rules out?
//
// Between two updates the pose gets process noise w ~ N(0, Q), Q accumulated through the motion.
// An observation with joint innovation nu (covariance S, columns H_p of the pose) implies
//     w = Q g,   g = H_p^T S^-1 nu,   q = w^T Q^-1 w = g^T Q g
// Since S - H_p Q H_p^T is positive semi-definite, q is at most chi-square with the dimension of
// the pose while the filter is right. A tracker that froze, or jumped to other points as a whole,
// agrees with itself: no gate of a single landmark and no joint test of nu sees it, because the map
// of a camera is uncertain along with its pose. But it implies that the robot stood, or flew.

#include <libslam/data/joint_innovation.hpp>
#include <libslam/state/block.hpp>

namespace libslam {

class ImpliedInput {
 public:
  /// `probability`: chi-square probability beyond which a motion is impossible. Throws
  /// std::invalid_argument unless in (0, 1).
  explicit ImpliedInput(double probability);

  /// The pose has moved: its error is `transition` times that before plus noise (tangent x
  /// tangent).
  void move(const BlockMatrix& transition, const BlockMatrix& cov_noise);
  /// q of an observation before its correction; infinity where S is not positive definite.
  double squared_motion(const JointInnovation& joint) const;
  /// q is beyond the probability.
  bool impossible(const JointInnovation& joint) const;
  /// An observation has been used, or its landmarks start anew: the noise counts from here.
  void restart();

 private:
  double probability_;
  BlockMatrix cov_;  // Q
};

}  // namespace libslam
