#pragma once
// Square tags in one image: AprilTag and ArUco behind one contract. Private to the front-ends: it
// includes OpenCV.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace libslam {

struct DetectedTag {
  int id = 0;
  /// Outer corners of the black border [px] (pixel centres at whole numbers): top left, top right,
  /// bottom right, bottom left of the upright tag seen from its front.
  std::array<Eigen::Vector2d, 4> corners;
};

class TagDetector {
 public:
  virtual ~TagDetector() = default;
  /// Tags in the order of their ids; a tag seen twice is left out, as it is nowhere for certain.
  std::vector<DetectedTag> detect(const cv::Mat& gray) const;

 private:
  virtual std::vector<DetectedTag> find(const cv::Mat& gray) const = 0;
};

/// `family`: "tag36h11" ... of AprilTag (Wang & Olson, IROS 2016), "DICT_4X4_50" ... of OpenCV's
/// ArUco, its corners refined. `decimate` as AprilTag has it. Throws std::invalid_argument on an
/// unknown family.
std::unique_ptr<TagDetector> make_tag_detector(const std::string& family, double decimate);

}  // namespace libslam
