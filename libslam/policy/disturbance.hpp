#pragma once
// Slip, a push, a kidnap: has something moved the robot that its odometry does not know of, and how
// far?
//
// Test.  d^2 = nu^T S^-1 nu of an observation, with the innovations that the gate rejected, is
// chi-square with m degrees of freedom while the filter is right. A disturbance begins where d^2 of
// one update, or its sum over the last `window` updates, is beyond the trigger level; it ends after
// `hold` updates below the release level, or after `kBlindHolds` times as many that say nothing,
// with none between them that is not.
//
// Inflation.  A displacement is independent of the map and of the error before it, so it adds
// s^2 C to the block of the pose and leaves the cross terms alone:
//     S(s) = S + s^2 H_p C H_p^T,   s = argmax log N(nu; 0, S(s)) over a grid of scales.
// With L L^T = S, w = L^-1 nu, G = L^-1 H_p C^1/2, A = G^T G, b = G^T w, all scales cost one
// factorization of S:  d^2(s) = w^T w - s^2 b^T (I + s^2 A)^-1 b,  log|S(s)| - log|S| =
// log|I + s^2 A|.
//
// Sources: Bar-Shalom, Li & Kirubarajan, "Estimation with Applications to Tracking and Navigation",
// 2001, 5.4 (test); Zhou & Frank, "Strong tracking filtering of nonlinear time-varying stochastic
// systems", Int. J. Control 65(2), 1996 (the factor of `whole_state`).

#include <array>
#include <deque>

#include <libslam/data/joint_innovation.hpp>
#include <libslam/state/block.hpp>

namespace libslam {

enum class Inflation {
  kMaximumLikelihood,  ///< the pose, by the scale that fits best
  kAdditive,           ///< the pose, by scale 1
  kWholeState,         ///< all of P, by a factor: moves the map, too
};

struct DisturbanceOptions {
  Inflation inflation = Inflation::kMaximumLikelihood;
  int window = 5;  ///< updates
  double trigger_probability = 0.99999;
  double release_probability = 0.95;
  int hold = 5;                              ///< updates
  BlockVector sigma = BlockVector::Ones(3);  ///< C = diag(sigma)^2, tangent of the pose
  double max_factor = 100.0;                 ///< kWholeState
};

class Disturbance {
 public:
  /// Updates without evidence end a disturbance after so many times `hold`.
  static constexpr int kBlindHolds = 10;
  /// The scales of the grid.
  static constexpr std::array<double, 9> kScales = {0.0, 0.03, 0.1, 0.2, 0.4, 0.7, 1.0, 2.0, 4.0};

  /// Throws std::invalid_argument where a window, a probability or a sigma is out of range.
  explicit Disturbance(DisturbanceOptions options);

  /// Judges an observation before its correction: its d^2 with `dof` degrees of freedom (0: it says
  /// nothing), and whether it is estranged: unlike the map although near it. True: inflate now.
  bool judge(double nis, int dof, bool estranged);
  /// Below the trigger level.
  bool possible(double nis, int dof) const;
  /// Below the release level.
  bool quiet(double nis, int dof) const;
  /// True from the trigger to the release.
  bool lasts() const { return lasts_; }
  /// The last `judge` began a disturbance.
  bool began() const { return began_; }
  /// Begins a disturbance, or goes on with it, for another reason than `judge` knows.
  void begin();
  /// Ends a disturbance: the pose has been found again, and earlier innovations say nothing.
  void settle();

  Inflation inflation() const { return options_.inflation; }
  /// d^2; infinity where S is not positive definite.
  static double squared_distance(const JointInnovation& joint);
  /// s, for kMaximumLikelihood and kAdditive; 0 where S is not positive definite.
  double scale(const JointInnovation& joint) const;
  /// s^2 C.
  BlockMatrix added(double scale) const;
  /// Factor on P for kWholeState: (nu^T nu - tr R) / tr(H P H^T) in [1, max_factor].
  double factor(const JointInnovation& joint) const;

 private:
  struct Sum {
    double nis = 0.0;
    int dof = 0;
  };

  DisturbanceOptions options_;
  std::deque<Sum> recent_;
  bool lasts_ = false, began_ = false;
  int quiet_ = 0, blind_ = 0;
};

}  // namespace libslam
