#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include <libslam/frontend/stereo_matching.hpp>

namespace libslam {

namespace {

/// Window of the refinement [px].
constexpr int kWindow = 13;
/// A point that is followed to the other image and back must return within this distance [px].
constexpr float kReturn = 0.5F;
/// Half of the patch of a row search [px].
constexpr int kHalfPatch = 5;
constexpr double kLeastCorrelation = 0.85;
/// A second peak of this share of the first makes a row ambiguous.
constexpr double kSecondPeak = 0.95;

/// Right points by the image row they lie in.
std::vector<std::vector<int>> rows_of(const DetectedPoints& points, int rows) {
  std::vector<std::vector<int>> table(static_cast<std::size_t>(rows));
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const int row = std::clamp(static_cast<int>(points.points[i].pt.y), 0, rows - 1);
    table[static_cast<std::size_t>(row)].push_back(static_cast<int>(i));
  }
  return table;
}

struct Best {
  int partner = -1;
  double distance = std::numeric_limits<double>::infinity();
};

cv::Rect patch_about(const cv::Point2f& p) {
  const int x = static_cast<int>(std::lround(p.x)), y = static_cast<int>(std::lround(p.y));
  return {x - kHalfPatch, y - kHalfPatch, 2 * kHalfPatch + 1, 2 * kHalfPatch + 1};
}

/// Column from `first` to `last` where the patch is found in the rows from `row` on, or nothing.
std::optional<int> find_along_row(const cv::Mat& patch, const cv::Mat& image, int row, int first,
                                  int last) {
  const cv::Rect strip(first, row, last - first + patch.cols, patch.rows);
  cv::Mat scores;
  cv::matchTemplate(image(strip), patch, scores, cv::TM_CCOEFF_NORMED);
  cv::Point peak;
  double best = 0.0;
  cv::minMaxLoc(scores, nullptr, &best, nullptr, &peak);
  if (best < kLeastCorrelation) return std::nullopt;
  for (int x = 0; x < scores.cols; ++x)
    if (std::abs(x - peak.x) > 2 && scores.at<float>(0, x) > kSecondPeak * best)
      return std::nullopt;
  return first + peak.x;
}

}  // namespace

std::vector<std::pair<int, int>> match_rows(const StereoFrontendParameters& parameters,
                                            const FeatureDetector& detector,
                                            const DetectedPoints& left,
                                            const DetectedPoints& right) {
  float lowest = 0.0F;
  for (const auto* side : {&left, &right})
    for (const cv::KeyPoint& point : side->points) lowest = std::max(lowest, point.pt.y);
  const int rows = static_cast<int>(lowest) + 1;
  const auto table = rows_of(right, rows);
  std::vector<Best> of_left(left.points.size()), of_right(right.points.size());
  for (std::size_t i = 0; i < left.points.size(); ++i) {
    const cv::KeyPoint& l = left.points[i];
    const double band = parameters.row_tolerance * detector.scale_of(l);
    const int first = std::max(0, static_cast<int>(l.pt.y - band));
    const int last = std::min(rows - 1, static_cast<int>(l.pt.y + band));
    for (int row = first; row <= last; ++row)
      for (const int j : table[static_cast<std::size_t>(row)]) {
        const cv::KeyPoint& r = right.points[static_cast<std::size_t>(j)];
        const double d = l.pt.x - r.pt.x;
        if (std::abs(l.pt.y - r.pt.y) > band || d <= 0.0 || d > parameters.max_disparity ||
            std::abs((l.octave & 255) - (r.octave & 255)) > 1)
          continue;
        const double distance = relative_distance(*left.descriptors[i],
                                                  *right.descriptors[static_cast<std::size_t>(j)]);
        if (distance < of_left[i].distance) of_left[i] = {j, distance};
        Best& back = of_right[static_cast<std::size_t>(j)];
        if (distance < back.distance) back = {static_cast<int>(i), distance};
      }
  }
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i < of_left.size(); ++i) {
    const auto& [j, distance] = of_left[i];
    if (j >= 0 && distance <= parameters.max_distance &&
        of_right[static_cast<std::size_t>(j)].partner == static_cast<int>(i))
      pairs.emplace_back(static_cast<int>(i), j);
  }
  return pairs;
}

std::vector<std::optional<cv::Point2f>> search_rows(const StereoFrontendParameters& parameters,
                                                    const cv::Mat& left, const cv::Mat& right,
                                                    const std::vector<cv::Point2f>& corners) {
  std::vector<std::optional<cv::Point2f>> partners(corners.size());
  const cv::Rect image({0, 0}, left.size());
  const int most = static_cast<int>(parameters.max_disparity);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const cv::Rect patch = patch_about(corners[i]);
    if ((patch & image) != patch) continue;
    const int nearest = std::max(0, patch.x - most);
    const auto there = find_along_row(left(patch), right, patch.y, nearest, patch.x);
    if (!there) continue;
    const cv::Rect partner(*there, patch.y, patch.width, patch.height);
    const int farthest = std::min(image.width - patch.width, *there + most);
    const auto back = find_along_row(right(partner), left, patch.y, *there, farthest);
    if (!back || std::abs(*back - patch.x) > 1) continue;
    partners[i] = cv::Point2f(corners[i].x - static_cast<float>(patch.x - *there), corners[i].y);
  }
  return partners;
}

std::vector<bool> refine_positions(const cv::Mat& from, const cv::Mat& to,
                                   const std::vector<cv::Point2f>& points,
                                   std::vector<cv::Point2f>& guesses, int levels) {
  std::vector<bool> good(points.size(), false);
  if (points.empty()) return good;
  const cv::TermCriteria stop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01);
  std::vector<std::uint8_t> there, back;
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(from, to, points, guesses, there, error, {kWindow, kWindow}, levels,
                           stop, cv::OPTFLOW_USE_INITIAL_FLOW);
  std::vector<cv::Point2f> returned = points;
  cv::calcOpticalFlowPyrLK(to, from, guesses, returned, back, error, {kWindow, kWindow}, levels,
                           stop, cv::OPTFLOW_USE_INITIAL_FLOW);
  const cv::Rect2f inside(0.0F, 0.0F, static_cast<float>(to.cols), static_cast<float>(to.rows));
  for (std::size_t i = 0; i < points.size(); ++i)
    good[i] = there[i] != 0 && back[i] != 0 && inside.contains(guesses[i]) &&
              cv::norm(returned[i] - points[i]) <= kReturn;
  return good;
}

std::optional<StereoMatch> make_stereo_match(const StereoFrontendParameters& parameters,
                                             const cv::Point2f& left, const cv::Point2f& right) {
  StereoMatch point;
  point.sigma = parameters.sigma_pixel;
  point.row_error = static_cast<double>(left.y) - static_cast<double>(right.y);
  point.z = {left.x, 0.5 * (static_cast<double>(left.y) + static_cast<double>(right.y)),
             static_cast<double>(left.x) - static_cast<double>(right.x)};
  if (std::abs(point.row_error) > parameters.row_tolerance) return std::nullopt;
  if (point.z[2] > parameters.max_disparity || !has_depth(point)) return std::nullopt;
  return point;
}

}  // namespace libslam
