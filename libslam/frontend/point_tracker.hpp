#pragma once
// Contract of trackers: a rectified pair in, the tracks of its stereo points out. Private to the
// front-ends: it includes OpenCV.

#include <memory>

#include <libslam/config/parameters/stereo.hpp>
#include <libslam/frontend/point_tracks.hpp>
#include <libslam/frontend/stereo_rectification.hpp>

namespace libslam {

/// What one pair of images gave.
struct PairFigures {
  int detected = 0;        ///< points sought in the left image
  int matched = 0;         ///< stereo points
  int followed = 0;        ///< tracks continued
  double row_error = 0.0;  ///< mean |v_left - v_right| of the stereo points [px]
};

class PointTracker {
 public:
  virtual ~PointTracker() = default;
  /// Tracks with `unseen` = 0 are those of this pair.
  virtual PairFigures track(const RectifiedPair& pair, PointTracks& tracks) = 0;
};

/// Points are found again by their descriptors, near where the motion before lets expect them;
/// their places are then refined against the image before.
std::unique_ptr<PointTracker> make_descriptor_tracker(const StereoFrontendParameters& parameters);

/// Corners (Shi & Tomasi 1994) are followed by their surroundings from pair to pair; new ones begin
/// where the image has none.
std::unique_ptr<PointTracker> make_corner_tracker(const StereoFrontendParameters& parameters);

}  // namespace libslam
