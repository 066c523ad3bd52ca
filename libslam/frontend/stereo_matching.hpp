#pragma once
// Points of the left image found in the right one. Private to the front-ends: it includes OpenCV.

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include <libslam/config/parameters/stereo.hpp>
#include <libslam/frontend/feature_detection.hpp>
#include <libslam/frontend/stereo_match.hpp>

namespace libslam {

/// Pairs (left, right) of points by descriptor: the rows agree within the tolerance (times the
/// scale of the point), the disparity is in (0, max_disparity], the octaves are neighbours, the
/// descriptors near, and each is the best of the other (left-right check).
std::vector<std::pair<int, int>> match_rows(const StereoFrontendParameters& parameters,
                                            const FeatureDetector& detector,
                                            const DetectedPoints& left,
                                            const DetectedPoints& right);

/// Right partners of corners that have no descriptor: the best normalized correlation of their
/// surroundings along the row, clearly better than any other, and the same way back; whole pixels.
std::vector<std::optional<cv::Point2f>> search_rows(const StereoFrontendParameters& parameters,
                                                    const cv::Mat& left, const cv::Mat& right,
                                                    const std::vector<cv::Point2f>& corners);

/// Moves first guesses in image `to` to where the surroundings of the points in image `from` are
/// really found, to a fraction of a pixel (Lucas-Kanade), and back again: false where they do not
/// return to where they started. `levels` of the pyramid above the first.
std::vector<bool> refine_positions(const cv::Mat& from, const cv::Mat& to,
                                   const std::vector<cv::Point2f>& points,
                                   std::vector<cv::Point2f>& guesses, int levels);

/// The stereo point of a pair of pixels; nothing if the rows differ by more than the tolerance, the
/// disparity is not in (0, max_disparity], or too small to tell a depth.
std::optional<StereoMatch> make_stereo_match(const StereoFrontendParameters& parameters,
                                             const cv::Point2f& left, const cv::Point2f& right);

}  // namespace libslam
