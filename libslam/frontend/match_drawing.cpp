#include <algorithm>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <libslam/frontend/match_drawing.hpp>
#include <libslam/frontend/stereo_rectification.hpp>

namespace libslam {

namespace {

/// Blue for d = 0, red for the largest disparity (BGR).
cv::Scalar colour_of(double disparity, double largest) {
  const double near = std::clamp(disparity / largest, 0.0, 1.0);
  return {255.0 * (1.0 - near), 200.0 * std::min(near, 1.0 - near) * 2.0, 255.0 * near};
}

}  // namespace

std::vector<std::uint8_t> draw_matches(const mrpt::obs::CObservationStereoImages& observation,
                                       const FeatureBatch& features) {
  RectifiedPair pair;
  try {
    pair = StereoRectifier().rectify(observation);
  } catch (const UnusableImages&) {
    return {};
  }
  cv::Mat both, picture;
  cv::vconcat(pair.left, pair.right, both);
  cv::cvtColor(both, picture, cv::COLOR_GRAY2BGR);
  double largest = 1.0;
  for (const Feature& feature : features) largest = std::max(largest, feature.z[2]);
  for (const Feature& feature : features) {
    const cv::Point2d left(feature.z[0], feature.z[1]);
    const cv::Point2d partner(feature.z[0] - feature.z[2], feature.z[1]);
    const cv::Point2d below(0.0, pair.left.rows);
    const cv::Scalar colour = colour_of(feature.z[2], largest);
    cv::line(picture, left, partner, colour, 1, cv::LINE_AA);
    cv::circle(picture, left, 2, colour, cv::FILLED, cv::LINE_AA);
    cv::circle(picture, partner + below, 2, colour, cv::FILLED, cv::LINE_AA);
  }
  std::vector<std::uint8_t> png;
  cv::imencode(".png", picture, png);
  return png;
}

}  // namespace libslam
