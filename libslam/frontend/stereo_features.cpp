#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <libslam/frontend/point_tracker.hpp>
#include <libslam/frontend/stereo_features.hpp>

namespace libslam {

namespace {

/// Later defects are counted only.
constexpr std::size_t kMostWarnings = 10;
/// Tracks of different cameras must not share identities; those of tags lie below.
constexpr std::int64_t kIdentitiesPerCamera = std::int64_t{1} << 28;
/// Features chosen per cell of the image, a turn each.
constexpr int kColumns = 12, kRows = 6;
/// A rectified pair of a good calibration has less than this [px].
constexpr double kSuspiciousRowError = 0.5;

std::unique_ptr<PointTracker> make_tracker(const StereoFrontendParameters& parameters) {
  if (parameters.tracker == "klt") return make_corner_tracker(parameters);
  if (parameters.tracker == "descriptors") return make_descriptor_tracker(parameters);
  throw std::invalid_argument("unknown tracker '" + parameters.tracker + "'");
}

int cell_of(const StereoCamera& camera, const Eigen::Vector3d& z) {
  const int column = std::clamp(static_cast<int>(z[0] * kColumns / camera.width), 0, kColumns - 1);
  const int row = std::clamp(static_cast<int>(z[1] * kRows / camera.height), 0, kRows - 1);
  return row * kColumns + column;
}

}  // namespace

/// One stereo camera of the robot.
class StereoFeatures::Camera {
 public:
  Camera(std::string name, int number, const FrontendParameters& parameters)
      : label(std::move(name)),
        channel(number),
        parameters_(parameters),
        tracker_(make_tracker(parameters.stereo)),
        tracks_(parameters.stereo.memory) {}

  FeatureBatch extract(const mrpt::obs::CObservationStereoImages& observation,
                       bool with_identities) {
    const RectifiedPair pair = rectifier_.rectify(observation);
    add(tracker_->track(pair, tracks_));
    FeatureBatch batch;
    for (const std::size_t k : choose(*pair.camera)) {
      PointTrack& track = tracks_.tracks()[k];
      track.delivered = true;
      Feature& feature = batch.emplace_back();
      feature.id = with_identities ? kIdentitiesPerCamera * channel + track.id : kNoIdentity;
      feature.channel = channel;
      feature.z = track.last.z;
      feature.cov = covariance_of(track.last);
      feature.camera = pair.camera;
      feature.appearance = track.last.appearance;
    }
    return batch;
  }

  const std::string label;
  const int channel;
  StereoFigures figures;

 private:
  void add(const PairFigures& pair) {
    const auto n = static_cast<double>(figures.pairs);
    figures.least_matched = figures.pairs == 0
                                ? pair.matched
                                : std::min<std::int64_t>(figures.least_matched, pair.matched);
    figures.mean_matched += (pair.matched - figures.mean_matched) / (n + 1.0);
    figures.mean_row_error += (pair.row_error - figures.mean_row_error) / (n + 1.0);
    if (figures.pairs > 0) figures.mean_followed += (pair.followed - figures.mean_followed) / n;
    ++figures.pairs;
  }

  /// The tracks of this pair that the filter gets: those it has, then the oldest, spread over the
  /// image.
  std::vector<std::size_t> choose(const StereoCamera& camera) const {
    const StereoFrontendParameters& stereo = parameters_.stereo;
    std::vector<std::size_t> ready;
    for (std::size_t k = 0; k < tracks_.tracks().size(); ++k) {
      const PointTrack& track = tracks_.tracks()[k];
      const double depth = track.p.z();
      if (track.unseen == 0 && (track.founding || track.sightings >= stereo.min_sightings) &&
          depth >= parameters_.min_range && depth <= parameters_.max_range)
        ready.push_back(k);
    }
    const auto rank = [this](std::size_t k) {
      const PointTrack& track = tracks_.tracks()[k];
      return std::make_tuple(!track.delivered, -track.sightings, track.id);
    };
    std::sort(ready.begin(), ready.end(),
              [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    std::vector<int> taken(kColumns * kRows, 0);
    std::vector<std::tuple<bool, int, std::size_t>> turns;  // new to the filter, turn, place
    for (std::size_t i = 0; i < ready.size(); ++i) {
      const PointTrack& track = tracks_.tracks()[ready[i]];
      const int turn = taken[static_cast<std::size_t>(cell_of(camera, track.last.z))]++;
      turns.emplace_back(!track.delivered, turn, i);
    }
    std::sort(turns.begin(), turns.end());
    turns.resize(std::min(turns.size(), static_cast<std::size_t>(stereo.delivered)));
    std::vector<std::size_t> chosen;
    for (const auto& [is_new, turn, i] : turns) chosen.push_back(ready[i]);
    return chosen;
  }

  FrontendParameters parameters_;
  StereoRectifier rectifier_;
  std::unique_ptr<PointTracker> tracker_;
  PointTracks tracks_;
};

StereoFeatures::StereoFeatures(const FrontendParameters& parameters, std::string sensor_label,
                               bool with_identities)
    : parameters_(parameters),
      sensor_label_(std::move(sensor_label)),
      with_identities_(with_identities) {
  Camera("", 0, parameters_);  // throws now rather than at the first pair
}

StereoFeatures::~StereoFeatures() = default;

StereoFeatures::Camera& StereoFeatures::camera_of(const std::string& label) {
  for (const auto& camera : cameras_)
    if (camera->label == label) return *camera;
  cameras_.push_back(
      std::make_unique<Camera>(label, static_cast<int>(cameras_.size()), parameters_));
  return *cameras_.back();
}

void StereoFeatures::extract(const mrpt::obs::CSensoryFrame& frame,
                             std::vector<FeatureBatch>& batches) {
  batches.clear();
  for (const auto& any : frame) {
    const auto* observation = dynamic_cast<const mrpt::obs::CObservationStereoImages*>(any.get());
    if (observation == nullptr) continue;
    if (!sensor_label_.empty() && observation->sensorLabel != sensor_label_) continue;
    try {
      FeatureBatch batch =
          camera_of(observation->sensorLabel).extract(*observation, with_identities_);
      if (!batch.empty()) batches.push_back(std::move(batch));
    } catch (const UnusableImages& defect) {
      ++unusable_;
      const bool repeated = !warnings_.empty() && warnings_.back() == defect.what();
      if (!repeated && warnings_.size() < kMostWarnings) warnings_.emplace_back(defect.what());
    }
    observation->imageLeft.unload();  // of external storage: memory is bounded
    observation->imageRight.unload();
  }
}

std::vector<std::string> StereoFeatures::warnings() const {
  std::vector<std::string> all = warnings_;
  for (const auto& camera : cameras_) {
    if (camera->figures.mean_row_error <= kSuspiciousRowError) continue;
    char text[128];
    std::snprintf(text, sizeof text,
                  "rows of matched points differ by %.2f px: is the calibration "
                  "that of these images?",
                  camera->figures.mean_row_error);
    all.push_back("stereo camera '" + camera->label + "': " + text);
  }
  return all;
}

std::map<std::string, double> StereoFeatures::figures() const {
  if (cameras_.empty()) return {};
  const StereoFigures& first = cameras_.front()->figures;
  return {{"pairs", static_cast<double>(first.pairs)},
          {"least_matched", static_cast<double>(first.least_matched)},
          {"mean_matched", first.mean_matched},
          {"mean_followed", first.mean_followed},
          {"mean_row_error_px", first.mean_row_error}};
}

}  // namespace libslam
