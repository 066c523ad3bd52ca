#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include <libslam/frontend/feature_detection.hpp>
#include <libslam/frontend/point_tracker.hpp>
#include <libslam/frontend/stereo_matching.hpp>

namespace libslam {

namespace {

/// Levels of the pyramid above the image: what the expected place may be wrong by, 13 px each
/// doubling.
constexpr int kLevels = 3;
/// A corner per the strongest one of the image.
constexpr double kQuality = 0.002;

cv::Point2f left_pixel(const StereoMatch& point) {
  return {static_cast<float>(point.z[0]), static_cast<float>(point.z[1] + 0.5 * point.row_error)};
}

class CornerTracker final : public PointTracker {
 public:
  explicit CornerTracker(const StereoFrontendParameters& parameters) : parameters_(parameters) {}

  PairFigures track(const RectifiedPair& pair, PointTracks& tracks) override {
    PairFigures figures;
    follow(pair, tracks, figures);
    replenish(pair, tracks, figures);
    if (figures.matched > 0) figures.row_error /= figures.matched;
    last_left_ = pair.left.clone();
    return figures;
  }

 private:
  void follow(const RectifiedPair& pair, PointTracks& tracks, PairFigures& figures) {
    std::vector<std::size_t> index;
    std::vector<cv::Point2f> before, left, right;
    const bool same_size = last_left_.size() == pair.left.size();
    for (std::size_t k = 0; same_size && k < tracks.tracks().size(); ++k) {
      const PointTrack& track = tracks.tracks()[k];
      const auto expected = tracks.expect(*pair.camera, track);
      if (track.unseen > 0 || !expected) continue;
      index.push_back(k);
      before.push_back(left_pixel(track.last));
      left.emplace_back(static_cast<float>((*expected)[0]), static_cast<float>((*expected)[1]));
      right.emplace_back(static_cast<float>((*expected)[0] - (*expected)[2]), left.back().y);
    }
    const std::vector<bool> found = refine_positions(last_left_, pair.left, before, left, kLevels);
    for (std::size_t i = 0; i < left.size(); ++i) {  // the depth barely changes, the place may
      const auto disparity =
          static_cast<float>((*tracks.expect(*pair.camera, tracks.tracks()[index[i]]))[2]);
      right[i] = {left[i].x - disparity, left[i].y};
    }
    const std::vector<bool> paired = refine_positions(pair.left, pair.right, left, right, 1);
    std::vector<Sighting> sightings;
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (!found[i] || !paired[i]) continue;
      auto point = make_stereo_match(parameters_, left[i], right[i]);
      if (!point) continue;
      point->appearance = tracks.tracks()[index[i]].last.appearance;
      count(*point, figures);
      sightings.push_back({index[i], *point});
    }
    for (const bool accepted : tracks.confirm(*pair.camera, sightings))
      figures.followed += accepted ? 1 : 0;
  }

  void replenish(const RectifiedPair& pair, PointTracks& tracks, PairFigures& figures) {
    const std::vector<cv::Point2f> corners = find_corners(pair.left, tracks);
    figures.detected = static_cast<int>(corners.size() + tracks.tracks().size());
    const auto partners = search_rows(parameters_, pair.left, pair.right, corners);
    std::vector<cv::Point2f> left, right;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (!partners[i]) continue;
      left.push_back(corners[i]);
      right.push_back(*partners[i]);
    }
    const std::vector<cv::Point2f> coarse = right;
    const std::vector<bool> good = refine_positions(pair.left, pair.right, left, right, 0);
    const auto appearances = describe_corners(pair.left, left);
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (!good[i] || cv::norm(right[i] - coarse[i]) > 1.5) continue;
      auto point = make_stereo_match(parameters_, left[i], right[i]);
      if (!point) continue;
      point->appearance = appearances[i];
      count(*point, figures);
      tracks.begin(*pair.camera, *point);
    }
  }

  /// New corners, away from those that are followed already.
  std::vector<cv::Point2f> find_corners(const cv::Mat& image, const PointTracks& tracks) const {
    const int wanted = parameters_.detected - static_cast<int>(tracks.tracks().size());
    std::vector<cv::Point2f> corners;
    if (wanted <= 0) return corners;
    // Apart by half of the side of a square that each point would have for itself.
    const double apart = std::max(
        3.0, 0.5 * std::sqrt(static_cast<double>(image.size().area()) / parameters_.detected));
    cv::Mat free(image.size(), CV_8U, cv::Scalar(255));
    for (const PointTrack& track : tracks.tracks())
      cv::circle(free, left_pixel(track.last), static_cast<int>(apart), cv::Scalar(0), cv::FILLED);
    cv::goodFeaturesToTrack(image, corners, 4 * wanted, kQuality, apart, free, 3);
    std::vector<cv::KeyPoint> points;
    for (std::size_t i = 0; i < corners.size(); ++i)  // strongest first, without saying how strong
      points.emplace_back(corners[i], 1.0F, -1.0F, -static_cast<float>(i));
    spread(points, image.size(), wanted);
    corners.clear();
    for (const cv::KeyPoint& point : points) corners.push_back(point.pt);
    return corners;
  }

  static void count(const StereoMatch& point, PairFigures& figures) {
    ++figures.matched;
    figures.row_error += std::abs(point.row_error);
  }

  StereoFrontendParameters parameters_;
  cv::Mat last_left_;
};

}  // namespace

std::unique_ptr<PointTracker> make_corner_tracker(const StereoFrontendParameters& parameters) {
  return std::make_unique<CornerTracker>(parameters);
}

}  // namespace libslam
