#pragma once
// Whether the optional odometry fields of a log, velocities and encoder ticks, can be believed.
//
// Logs written by old versions of MRPT carry whatever was in memory where these fields are today. A
// field is believed once its first readings agree with the pose increments of the same log:
//
//   velocities   |(v dt, omega dt) - (ds, dphi)| <= tolerance |(ds, dphi)|
//   ticks        the same for the best linear map from (left, right) to (ds, dphi)
//
// with the root mean square over the readings, separately for distance and turn. The turn is judged
// against at least 0.1 rad per metre driven, the distance against at least 0.1 m per radian turned:
// below that a path is straight, or turns on the spot, and the rest is noise.

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace libslam {

enum class FieldVerdict {
  kAbsent,     ///< no reading carried the field
  kUndecided,  ///< plausible so far, too few moving readings to compare
  kSane,       ///< agrees with the increments
  kInsane,     ///< garbage, or at odds with the increments; never revised
};

/// Watches one optional field.
class FieldCheck {
 public:
  /// How the field relates to the increments.
  enum class Relation {
    kEqual,         ///< a movement (ds [m], dphi [rad]) itself
    kProportional,  ///< an unknown linear map gives the movement
  };

  /// Number of moving readings that a verdict takes.
  static constexpr int kReadings = 50;

  /// `tolerance`: relative, see above.
  FieldCheck(Relation relation, double tolerance) : relation_(relation), tolerance_(tolerance) {}

  /// A plausible reading of step `step` beside the movement (ds, dphi) of the increment.
  void observe(std::int64_t step, const Eigen::Vector2d& reading, const Eigen::Vector2d& movement);
  /// The field is there, but has nothing to compare (no interval).
  void note_present();
  /// The reading of step `step` is impossible by itself.
  void condemn(std::int64_t step, const std::string& reason);

  FieldVerdict verdict() const { return verdict_; }
  /// Why the verdict is kInsane, naming the step; else empty.
  const std::string& reason() const { return reason_; }

 private:
  struct Pair {
    Eigen::Vector2d reading, movement;
  };
  /// Empty if the collected readings agree, else what does not.
  std::string find_disagreement() const;

  Relation relation_;
  double tolerance_;
  FieldVerdict verdict_ = FieldVerdict::kAbsent;
  std::string reason_;
  std::vector<Pair> pairs_;
  int moving_ = 0;
};

}  // namespace libslam
