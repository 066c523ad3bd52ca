#pragma once
// CObservationStereoImagesFeatures -> stereo points (measurement/stereo_point.hpp).

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <mrpt/obs/CObservationStereoImagesFeatures.h>

#include <libslam/config/parameters.hpp>
#include <libslam/frontend/channel_numbers.hpp>
#include <libslam/frontend/frontend.hpp>

namespace libslam {

/// z = (u, v, d): the left column, the mean of both rows weighted by their variances, and the
/// disparity. With independent noise of the four coordinates
///     var u = s_ul^2,  var d = s_ul^2 + s_ur^2,  cov(u, d) = s_ul^2,
///     var v = 1 / (1 / s_vl^2 + 1 / s_vr^2),  v independent of both.
///
/// MRPT's conventions hold: camera axes X right, Y down, Z forward; the pose on the robot is that
/// of the left camera. Points of an observation that is not rectified (lenses with distortion,
/// cameras that are turned against each other, of different focal length or centre, or whose
/// baseline is not along X and positive) and coordinates that are not finite are counted as
/// unusable. A point without a depth between frontend.min_range and max_range is left out, one
/// with d <= 0 among them.
class StereoObservation final : public Frontend {
 public:
  /// `with_identities` false: features carry none, whatever the log says.
  StereoObservation(const FrontendParameters& frontend, const StereoNoiseParameters& noise,
                    std::string sensor_label, bool with_identities);
  void extract(const mrpt::obs::CSensoryFrame& frame, std::vector<FeatureBatch>& batches) override;
  std::int64_t unusable() const override { return unusable_; }

 private:
  /// The camera of an observation, shared by consecutive observations as long as it is the same.
  std::shared_ptr<const StereoCamera> share(const StereoCamera& camera);
  void add(const mrpt::obs::TStereoImageFeatures& point, int channel,
           const std::shared_ptr<const StereoCamera>& camera, FeatureBatch& batch);

  double min_range_, max_range_;
  bool with_identities_;
  std::string sensor_label_;
  double weight_left_;  // of the left row in the mean
  MeasurementMatrix cov_;
  std::shared_ptr<const StereoCamera> camera_;
  ChannelNumbers channels_;
  std::int64_t unusable_ = 0;
};

}  // namespace libslam
