#pragma once
// map.simplemap: key poses with what was seen there, for MRPT's map building tools.

#include <filesystem>
#include <vector>

#include <Eigen/Core>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDF.h>

#include <libslam/data/spatial_pose.hpp>
#include <libslam/data/trajectory.hpp>

namespace libslam {

/// Collects (pose, frame) pairs while a run goes and writes them as a mrpt::maps::CSimpleMap.
///
/// A pair is kept where the robot moved far enough from the last kept one. Beyond `max_pairs` every
/// second pair is dropped and the spacing doubled, so that memory holds at most that many frames.
/// Frames are shared, not copied: the caller must not change a frame that was handed in.
class SimpleMapWriter {
 public:
  struct Spacing {
    double distance_m = 0.5;
    double turn_rad = 0.35;
  };

  /// Throws std::invalid_argument where max_pairs < 2 or a spacing is negative.
  explicit SimpleMapWriter(Spacing spacing, std::size_t max_pairs = 2000);
  SimpleMapWriter() : SimpleMapWriter(Spacing{}) {}

  /// Pose (x [m], y [m], phi [rad]) with its additive covariance, and the frame seen there; null
  /// frames are ignored. `time` [s]: for `correct` alone.
  void add(const Eigen::Vector3d& pose, const Eigen::Matrix3d& cov,
           const mrpt::obs::CSensoryFrame::Ptr& frame, double time = 0.0);
  /// The same in space. The covariance becomes one of (x, y, z, yaw, pitch, roll) to first order.
  void add(const SpatialEstimate& estimate, const mrpt::obs::CSensoryFrame::Ptr& frame,
           double time = 0.0);
  /// Moves the pairs that were added with a time of `path` to its pose then, if it has just one;
  /// they keep their covariance. A path in the plane, whose times do not decrease.
  void correct(const Trajectory& path);

  std::size_t size() const { return pairs_.size(); }
  /// The pairs that were kept; their frames are shared.
  mrpt::maps::CSimpleMap map() const;

  /// Replaces `file` at once or not at all. Throws std::runtime_error naming it where it cannot be
  /// written.
  void write(const std::filesystem::path& file) const;

 private:
  struct Pair {
    SpatialPose place;  ///< decides about the spacing
    mrpt::poses::CPose3DPDF::Ptr pose;
    mrpt::obs::CSensoryFrame::Ptr frame;
    double time = 0.0;
  };
  bool is_far_enough(const SpatialPose& place) const;
  void drop_every_second();

  Spacing spacing_;
  std::size_t max_pairs_;
  std::vector<Pair> pairs_;
};

}  // namespace libslam
