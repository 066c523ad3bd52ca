#pragma once
// Which stereo points of one pair are those of the pair before: running identities for what stands
// still.

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <libslam/frontend/stereo_match.hpp>
#include <libslam/frontend/stereo_motion.hpp>

namespace libslam {

struct PointTrack {
  std::int64_t id = 0;
  int sightings = 1;                            ///< in accordance with the motion of the camera
  int unseen = 0;                               ///< pairs since the last sighting
  bool founding = false;                        ///< began where there was no motion to check it by
  bool delivered = false;                       ///< the filter has it
  StereoMatch last;                             ///< as it was sighted last
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< in the present camera frame [m]
  Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();  ///< of `p`
};

/// A sighting that some matcher believes to be one of a track.
struct Sighting {
  std::size_t track = 0;  ///< position in PointTracks::tracks
  StereoMatch point;
};

/// Tracks live as long as their sightings fit one rigid motion of the camera from pair to pair. A
/// sighting that does not fit (something that moves, a wrong match) ends its track.
class PointTracks {
 public:
  /// `memory`: pairs that a track survives unseen.
  explicit PointTracks(int memory) : memory_(memory) {}

  const std::vector<PointTrack>& tracks() const { return tracks_; }
  std::vector<PointTrack>& tracks() { return tracks_; }

  /// (u, v, d) at which a track is expected if the camera moves as it did before; nothing behind
  /// the camera.
  std::optional<Eigen::Vector3d> expect(const StereoCamera& camera, const PointTrack& track) const;

  /// Enters the sightings of one pair, at most one for each track. Says for each whether it was
  /// accepted. Without a motion that enough of them support, every track ends.
  std::vector<bool> confirm(const StereoCamera& camera, const std::vector<Sighting>& sightings);
  /// Begins a track.
  void begin(const StereoCamera& camera, const StereoMatch& point);

  /// Of the last pair; nothing where none was found.
  const std::optional<StereoMotion>& motion() const { return motion_; }

 private:
  void advance(const Eigen::Isometry3d& T_after_before);

  int memory_;
  std::int64_t next_id_ = 0;
  bool founding_ = true;
  std::vector<PointTrack> tracks_;
  std::optional<StereoMotion> motion_;
};

}  // namespace libslam
