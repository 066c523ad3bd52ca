#include <libslam/frontend/point_tracks.hpp>

namespace libslam {

namespace {

/// chi-square of 3 degrees of freedom, 99.5 %.
constexpr double kGate = 12.84;
constexpr double kNearest = 1e-3;  ///< depth [m]

}  // namespace

std::optional<Eigen::Vector3d> PointTracks::expect(const StereoCamera& camera,
                                                   const PointTrack& track) const {
  Eigen::Vector3d p = track.p;
  if (motion_) p = motion_->T_after_before * p;
  if (p.z() < kNearest) return std::nullopt;
  return project(camera, p);
}

std::vector<bool> PointTracks::confirm(const StereoCamera& camera,
                                       const std::vector<Sighting>& sightings) {
  std::vector<SightingPair> pairs;
  pairs.reserve(sightings.size());
  for (const Sighting& sighting : sightings) {
    const PointTrack& track = tracks_[sighting.track];
    pairs.push_back({track.p, track.cov, sighting.point.z, covariance_of(sighting.point)});
  }
  const Eigen::Isometry3d guess = motion_ ? motion_->T_after_before : Eigen::Isometry3d::Identity();
  const bool first = tracks_.empty();
  motion_ = estimate_stereo_motion(camera, pairs, guess, kGate);
  founding_ = !motion_.has_value();
  if (!motion_) {
    if (!first) tracks_.clear();
    return std::vector<bool>(sightings.size(), false);
  }
  for (PointTrack& track : tracks_) ++track.unseen;
  advance(motion_->T_after_before);
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    PointTrack& track = tracks_[sightings[i].track];
    if (!motion_->agrees[i]) {
      track.unseen = memory_ + 1;  // ends
      continue;
    }
    ++track.sightings;
    track.unseen = 0;
    track.last = sightings[i].point;
    locate(camera, track.last, track.p, track.cov);
  }
  std::erase_if(tracks_, [this](const PointTrack& track) { return track.unseen > memory_; });
  return motion_->agrees;
}

void PointTracks::begin(const StereoCamera& camera, const StereoMatch& point) {
  PointTrack track;
  track.id = next_id_++;
  track.founding = founding_;
  track.last = point;
  locate(camera, point, track.p, track.cov);
  tracks_.push_back(std::move(track));
}

void PointTracks::advance(const Eigen::Isometry3d& T_after_before) {
  for (PointTrack& track : tracks_) {
    track.p = T_after_before * track.p;
    track.cov = T_after_before.linear() * track.cov * T_after_before.linear().transpose();
  }
}

}  // namespace libslam
