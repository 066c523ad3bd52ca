#pragma once
// CObservationStereoImages -> points (u, v, d) of the rectified left camera, with identities that
// last as long as a point can be followed.
//
//   rectify -> detect -> match along rows -> refine -> follow from pair to pair -> choose
//
// A point is followed only while its sightings fit the one motion of the camera that most points
// support; what moves by itself, or was matched wrongly, loses its identity. Two runs give the same
// bytes for any number of OpenCV's threads: everything random has a fixed seed, and what OpenCV
// finds in parallel is put in order. cv::setRNGSeed is not needed.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <mrpt/obs/CObservationStereoImages.h>

#include <libslam/config/parameters.hpp>
#include <libslam/frontend/frontend.hpp>

namespace libslam {

/// Of all pairs so far.
struct StereoFigures {
  std::int64_t pairs = 0;
  std::int64_t least_matched = 0;  ///< stereo points of the poorest pair
  double mean_matched = 0.0;       ///< stereo points per pair
  double mean_followed = 0.0;      ///< tracks continued, per pair after the first
  double mean_row_error = 0.0;     ///< mean |v_left - v_right| [px]: more than 0.5 is suspicious
};

class StereoFeatures final : public Frontend {
 public:
  /// Reads the observations labelled `sensor_label` (empty: all, each label with its own tracks).
  /// `with_identities` false: features carry none, and are chosen in the same way. Throws
  /// std::invalid_argument on an unknown detector or tracker.
  StereoFeatures(const FrontendParameters& parameters, std::string sensor_label,
                 bool with_identities);
  ~StereoFeatures() override;

  /// Pairs that cannot be used (UnusableImages) are counted and named in `warnings`.
  void extract(const mrpt::obs::CSensoryFrame& frame, std::vector<FeatureBatch>& batches) override;
  std::int64_t unusable() const override { return unusable_; }
  std::vector<std::string> warnings() const override;

  /// StereoFigures of the first camera: pairs, least_matched, mean_matched, mean_followed,
  /// mean_row_error_px.
  std::map<std::string, double> figures() const override;

 private:
  class Camera;
  Camera& camera_of(const std::string& label);

  FrontendParameters parameters_;
  std::string sensor_label_;
  bool with_identities_;
  std::int64_t unusable_ = 0;
  std::vector<std::string> warnings_;
  std::vector<std::unique_ptr<Camera>> cameras_;  ///< one per label, in order of appearance
};

}  // namespace libslam
