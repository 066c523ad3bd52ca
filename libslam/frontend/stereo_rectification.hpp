#pragma once
// CObservationStereoImages -> a rectified pair of gray images and its camera. Private to the
// front-ends: it includes OpenCV.

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <mrpt/obs/CObservationStereoImages.h>
#include <opencv2/core.hpp>

#include <libslam/data/stereo_camera.hpp>

namespace libslam {

/// A pair of images that cannot be used; `what()` is one line that names the image or the value.
class UnusableImages : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A point of the world lies in the same row of both images.
struct RectifiedPair {
  cv::Mat left, right;  ///< 8 bit gray, of one size
  std::shared_ptr<const StereoCamera> camera;
};

/// Rectifies where the observation is not: distortion, a rotated or shifted right camera, or
/// different intrinsics (Bouguet's method, cv::stereoRectify). The tables are kept as long as the
/// calibration of the log does not change, and so is the camera.
class StereoRectifier {
 public:
  /// Throws UnusableImages where an image is missing, cannot be decoded or has another size than
  /// its partner, or the calibration is none: not finite, no focal length, or a right camera that
  /// is not to the right of the left one.
  RectifiedPair rectify(const mrpt::obs::CObservationStereoImages& observation);

 private:
  void adopt_calibration(const mrpt::obs::CObservationStereoImages& observation, cv::Size size);
  void compute_tables(const mrpt::obs::CObservationStereoImages& observation, cv::Size size);

  std::vector<double> calibration_;  ///< all numbers that the camera and the tables stem from
  std::shared_ptr<const StereoCamera> camera_;
  bool rectified_ = true;  ///< by the log
  cv::Mat left_map_[2], right_map_[2];
};

}  // namespace libslam
