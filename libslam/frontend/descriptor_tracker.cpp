#include <cmath>
#include <limits>
#include <utility>

#include <libslam/frontend/feature_detection.hpp>
#include <libslam/frontend/point_tracker.hpp>
#include <libslam/frontend/stereo_matching.hpp>

namespace libslam {

namespace {

/// A refined point belongs to its descriptor within this distance, times its scale [px].
constexpr float kRefinement = 2.5F;
/// Search radius about the expected place, as share of the width of the image.
constexpr double kSearch = 0.12;

/// A point of the left image with its right partner, not yet refined.
struct Candidate {
  cv::Point2f left, right;
  double scale = 1.0;
  bool placed = false;  ///< where the track was, or it begins here
  std::shared_ptr<const Descriptor> appearance;
};

struct Nearest {
  int index = -1;
  double best = std::numeric_limits<double>::infinity();
  double second = std::numeric_limits<double>::infinity();

  void offer(int candidate, double distance) {
    if (distance < best) {
      second = std::exchange(best, distance);
      index = candidate;
    } else if (distance < second) {
      second = distance;
    }
  }
};

cv::Point2f left_pixel(const StereoMatch& point) {
  return {static_cast<float>(point.z[0]), static_cast<float>(point.z[1] + 0.5 * point.row_error)};
}

class DescriptorTracker final : public PointTracker {
 public:
  explicit DescriptorTracker(const StereoFrontendParameters& parameters)
      : parameters_(parameters), detector_(parameters.detector, parameters.detected) {}

  PairFigures track(const RectifiedPair& pair, PointTracks& tracks) override {
    PairFigures figures;
    std::vector<Candidate> candidates = find_candidates(pair, figures);
    const std::vector<int> partner = find_partners(*pair.camera, tracks, candidates);
    refine_by_past(pair.left, tracks, partner, candidates);
    auto points = make_points(pair, candidates);
    std::vector<Sighting> sightings;
    std::vector<bool> used(points.size(), false);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i]) continue;
      ++figures.matched;
      figures.row_error += std::abs(points[i]->row_error);
      if (partner[i] < 0) continue;
      if (!candidates[i].placed)  // found anew, twice
        points[i]->place = std::sqrt(2.0) * candidates[i].scale * parameters_.sigma_pixel;
      sightings.push_back({static_cast<std::size_t>(partner[i]), *points[i]});
    }
    if (figures.matched > 0) figures.row_error /= figures.matched;
    enter(*pair.camera, tracks, points, partner, sightings, figures);
    last_left_ = pair.left.clone();
    return figures;
  }

 private:
  std::vector<Candidate> find_candidates(const RectifiedPair& pair, PairFigures& figures) const {
    const DetectedPoints left = detector_.detect(pair.left), right = detector_.detect(pair.right);
    figures.detected = static_cast<int>(left.points.size());
    std::vector<std::optional<cv::Point2f>> partners(left.points.size());
    for (const auto& [i, j] : match_rows(parameters_, detector_, left, right))
      partners[static_cast<std::size_t>(i)] = right.points[static_cast<std::size_t>(j)].pt;
    search_the_rest(pair, left.points, partners);
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < partners.size(); ++i)
      if (partners[i])
        candidates.push_back({left.points[i].pt, *partners[i], detector_.scale_of(left.points[i]),
                              false, left.descriptors[i]});
    return candidates;
  }

  /// Detectors do not find every point of one image in the other.
  void search_the_rest(const RectifiedPair& pair, const std::vector<cv::KeyPoint>& points,
                       std::vector<std::optional<cv::Point2f>>& partners) const {
    std::vector<cv::Point2f> alone;
    std::vector<std::size_t> index;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (partners[i]) continue;
      alone.push_back(points[i].pt);
      index.push_back(i);
    }
    const auto found = search_rows(parameters_, pair.left, pair.right, alone);
    for (std::size_t k = 0; k < index.size(); ++k) partners[index[k]] = found[k];
  }

  /// For every candidate its track, or -1: near the expected place, each the best of the other.
  std::vector<int> find_partners(const StereoCamera& camera, const PointTracks& tracks,
                                 const std::vector<Candidate>& candidates) const {
    std::vector<Nearest> of_candidate(candidates.size()), of_track(tracks.tracks().size());
    const double radius = kSearch * camera.width;
    for (std::size_t k = 0; k < of_track.size(); ++k) {
      const PointTrack& track = tracks.tracks()[k];
      const auto expected = tracks.expect(camera, track);
      if (!expected || !track.last.appearance) continue;
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        const cv::Point2f& at = candidates[i].left;
        if (std::abs(at.x - (*expected)[0]) > radius || std::abs(at.y - (*expected)[1]) > radius)
          continue;
        const double distance =
            relative_distance(*track.last.appearance, *candidates[i].appearance);
        of_track[k].offer(static_cast<int>(i), distance);
        of_candidate[i].offer(static_cast<int>(k), distance);
      }
    }
    std::vector<int> partner(candidates.size(), -1);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const Nearest& nearest = of_candidate[i];
      if (nearest.index < 0 || nearest.best > parameters_.max_distance) continue;
      const Nearest& back = of_track[static_cast<std::size_t>(nearest.index)];
      if (back.index == static_cast<int>(i) &&
          back.best <= parameters_.distance_ratio * back.second)
        partner[i] = nearest.index;
    }
    return partner;
  }

  /// Detectors place a point to about a pixel of its scale; what the image before showed there is
  /// found again to a fraction of a pixel.
  void refine_by_past(const cv::Mat& left, const PointTracks& tracks,
                      const std::vector<int>& partner, std::vector<Candidate>& candidates) const {
    if (last_left_.size() != left.size()) return;
    std::vector<std::size_t> index;
    std::vector<cv::Point2f> before, now;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (partner[i] < 0) continue;
      const PointTrack& track = tracks.tracks()[static_cast<std::size_t>(partner[i])];
      if (track.unseen > 0) continue;
      index.push_back(i);
      before.push_back(left_pixel(track.last));
      now.push_back(candidates[i].left);
    }
    const std::vector<bool> good = refine_positions(last_left_, left, before, now, 0);
    for (std::size_t k = 0; k < index.size(); ++k) {
      Candidate& candidate = candidates[index[k]];
      const cv::Point2f moved = now[k] - candidate.left;
      if (!good[k] || cv::norm(moved) > kRefinement * candidate.scale) continue;
      candidate.left = now[k];
      candidate.right += moved;
      candidate.placed = true;
    }
  }

  std::vector<std::optional<StereoMatch>> make_points(
      const RectifiedPair& pair, const std::vector<Candidate>& candidates) const {
    std::vector<cv::Point2f> left, right;
    for (const Candidate& candidate : candidates) {
      left.push_back(candidate.left);
      right.push_back(candidate.right);
    }
    const std::vector<bool> good = refine_positions(pair.left, pair.right, left, right, 0);
    std::vector<std::optional<StereoMatch>> points(candidates.size());
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const Candidate& candidate = candidates[i];
      const double moved = cv::norm(right[i] - candidate.right);
      if (!good[i] || moved > kRefinement * std::max(1.0, candidate.scale)) continue;
      points[i] = make_stereo_match(parameters_, left[i], right[i]);
      if (points[i]) points[i]->appearance = candidate.appearance;
    }
    return points;
  }

  static void enter(const StereoCamera& camera, PointTracks& tracks,
                    const std::vector<std::optional<StereoMatch>>& points,
                    const std::vector<int>& partner, const std::vector<Sighting>& sightings,
                    PairFigures& figures) {
    const std::vector<bool> accepted = tracks.confirm(camera, sightings);
    std::size_t next = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i]) continue;
      const bool continued = partner[i] >= 0 && accepted[next++];
      figures.followed += continued ? 1 : 0;
      if (!continued) tracks.begin(camera, *points[i]);
    }
  }

  StereoFrontendParameters parameters_;
  FeatureDetector detector_;
  cv::Mat last_left_;
};

}  // namespace

std::unique_ptr<PointTracker> make_descriptor_tracker(const StereoFrontendParameters& parameters) {
  return std::make_unique<DescriptorTracker>(parameters);
}

}  // namespace libslam
