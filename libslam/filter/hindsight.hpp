#pragma once
// Did the wheels slip in one of the last intervals between updates? And the filter that had known
// of it.
//
// A slip moves the robot by a t less than its odometry said, t the travel of an interval (world
// frame, orientation apart) and a ~ N(0, 1). It is smaller than what one update could tell from
// noise, and the filter has corrected map and calibration for it before anything is noticed.
//
// An error a t of the pose before an update shifts the error of the state by A a, A = t on the pose
// and 0 elsewhere. Motion, corrections and new landmarks carry A on as they carry the covariance
// of the state with anything: A <- F A, A <- (I - K H) A. The innovations that follow are shifted
// by H A a. Over all of them and several intervals, one column of A each, with G = H A,
//     C = sum G^T S^-1 G,   d = sum G^T S^-1 nu
// are all that they say, and the filter that had added t t^T to the covariance of the pose then
// would now have
//     x + A M d,   P + A M A^T,   M = (C + I)^-1,
//     2 log(likelihood of slips / of none) = d^T M d - log|C + I|.
// Nothing is processed again, and this is exact where the filter is linear.
//
// Shadows.  A block of the state with estimate 0, variance 0 and covariance t with the pose is
// carried on by the ordinary filter to estimate d, variance -C and covariance A with everything.
// The state keeps one for each of the last `kLookBack` updates. They are no part of what the filter
// estimates: P with them is not positive definite, P without them is what it always was.
//
// Decision.  Intervals slip in a row, each row of the window as likely as any other, with the prior
// probability p that one of them did: a slip where the odds p/(1-p) mean(likelihood ratio)
// exceed 1. While the filter is right this happens with a probability of at most p/(1-p) per update
// (Markov's inequality; the mean of a likelihood ratio is 1).
//
// Source: Willsky & Jones, "A generalized likelihood ratio approach to the detection and estimation
// of jumps in linear systems", IEEE Trans. Automatic Control 21(1), 1976.

#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include <Eigen/Core>

#include <libslam/filter/ekf.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

class Hindsight {
 public:
  /// Intervals that are remembered.
  static constexpr std::size_t kLookBack = 8;

  /// `slip_probability`: p, of a slip in the window. Throws std::invalid_argument unless in (0, 1).
  explicit Hindsight(double slip_probability);

  /// Before a correction, with the pose where the motion has left it. The first call adds the
  /// shadows to the state.
  void open(GaussianState& state, BlockId pose);
  /// After the correction: if the wheels have slipped, gives the state what it would be had the
  /// filter known of it, and returns true. The blocks in `given` do not change.
  bool reconsider(GaussianState& state, BlockId pose, Ekf& ekf, std::span<const BlockId> given);
  /// The pose has been found anew: travel and evidence begin here.
  void forget() { begun_ = false; }
  /// Blocks of the state that are shadows.
  std::span<const BlockId> shadows() const { return std::span(shadows_).first(added_); }

 private:
  static constexpr int kMost = static_cast<int>(kLookBack);
  using Evidence = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;
  using Shift = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;

  void gather(const GaussianState& state);
  /// The likeliest row of intervals, if the odds are for it: first and length, else length 0.
  std::pair<Eigen::Index, Eigen::Index> slipped() const;

  double odds_;                                     // p / (1 - p)
  std::array<BlockId, kLookBack> shadows_, order_;  // a ring; the oldest first
  std::size_t added_ = 0, next_ = 0;
  bool begun_ = false;
  TangentVector last_position_;  // after the last correction
  Evidence c_;
  Shift d_;
};

}  // namespace libslam
