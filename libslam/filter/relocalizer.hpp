#pragma once
// Finds a lost robot in its own map: by the constellation of what it has seen recently, or by the
// identities of what it sees now.
//
// The pose that is found is a function of the map and of the current observation. To get the
// covariance and all cross terms right, the filter forgets its pose: the block is put at the
// hypothesis, independent of the map and so uncertain that it says nothing, and the ordinary joint
// correction with the pairs of the observation, linearized there, does the rest. Planar poses and
// points.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/association/associator.hpp>
#include <libslam/association/constellation.hpp>
#include <libslam/association/landmark_registry.hpp>
#include <libslam/association/recent_sightings.hpp>
#include <libslam/measurement/measurement_model.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

/// A pose, and what the last observation sees of the map from there.
struct FoundPose {
  Eigen::Vector3d T_world_robot = Eigen::Vector3d::Zero();   ///< x [m], y [m], phi [rad]
  Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();             ///< relative to the map around it
  Eigen::Matrix3d cov_uninformed = Eigen::Matrix3d::Zero();  ///< to start the pose block with
  std::vector<Pairing> pairs;  ///< features of the observation, positions in the registry
};

class Relocalizer {
 public:
  /// Observations that are remembered.
  static constexpr std::size_t kMemory = 50;

  /// Forgets what was seen before something moved the robot.
  void restart();
  /// The pose moves from `before` to `after` (world frame); covariance of that step, world frame.
  void move(const Eigen::Vector3d& before, const Eigen::Vector3d& after,
            const Eigen::Matrix3d& cov);
  /// Remembers an observation; the pose of `state` only serves to place features on the robot.
  void observe(const GaussianState& state, BlockId pose, const MeasurementModel& measurement,
               std::span<const Feature> features);
  /// Nothing where no pose explains what was seen, or another one nearly as well, or the last
  /// observation alone does not fix it.
  std::optional<FoundPose> find(const GaussianState& state, const LandmarkRegistry& registry);
  /// The same by constellation, among the landmarks that were added `age` updates ago or earlier.
  std::optional<FoundPose> find_among_older(const GaussianState& state,
                                            const LandmarkRegistry& registry, int age);

 private:
  std::optional<FoundPose> find_by_identity(const GaussianState& state,
                                            const LandmarkRegistry& registry) const;
  std::optional<FoundPose> find_by_constellation(const GaussianState& state,
                                                 const LandmarkRegistry& registry);
  void index(const GaussianState& state, const LandmarkRegistry& registry, double reach);
  /// The feature of the last observation that is this sighting; nothing if none or several may be.
  std::optional<std::size_t> latest_of(const PlanarPoint& sighting) const;
  FoundPose found(const Eigen::Vector3d& pose, const Eigen::Matrix3d& cov) const;

  RecentSightings sightings_{kMemory};
  std::vector<PlanarPoint> latest_;             // the last observation, robot frame
  std::vector<std::int64_t> identities_;        // of its features
  double max_range_ = 0.0, max_bearing_ = 0.0;  // of all that was seen, sensor frame
  std::unique_ptr<ConstellationIndex> map_;
  double reach_ = 0.0;                  // of the distances in map_
  int least_age_ = 0;                   // of the landmarks in map_ [updates]
  std::vector<std::size_t> landmarks_;  // registry position of each point of map_
};

}  // namespace libslam
