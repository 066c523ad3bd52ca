#pragma once
// Points of one image with their descriptors. Private to the front-ends: it includes OpenCV.

#include <memory>
#include <string>
#include <vector>

#include <opencv2/features2d.hpp>

#include <libslam/data/descriptor.hpp>

namespace libslam {

struct DetectedPoints {
  std::vector<cv::KeyPoint> points;
  std::vector<std::shared_ptr<const Descriptor>> descriptors;  ///< one per point
};

/// The `budget` strongest of points with a response, spread over the image: cells of a grid give
/// their best one in turn. Their order depends on the points alone, not on how they came.
void spread(std::vector<cv::KeyPoint>& points, cv::Size size, int budget);

/// ORB, AKAZE or SIFT of OpenCV with thresholds low enough for plain walls.
class FeatureDetector {
 public:
  /// Throws std::invalid_argument where there is no detector of this name.
  FeatureDetector(const std::string& name, int budget);
  DetectedPoints detect(const cv::Mat& image) const;
  /// Standard deviation of a point per that of one of the finest scale, at least 1.
  double scale_of(const cv::KeyPoint& point) const;

 private:
  cv::Ptr<cv::Feature2D> detector_;
  int budget_;
  double octave_scale_;  ///< between two octaves of `KeyPoint::octave`; 0: from its size
  double finest_size_;   ///< [px]
};

/// Descriptors of corners without a scale or a direction (upright ORB); a point at the very border
/// has none.
std::vector<std::shared_ptr<const Descriptor>> describe_corners(
    const cv::Mat& image, const std::vector<cv::Point2f>& corners);

}  // namespace libslam
