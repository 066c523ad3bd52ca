#pragma once
// From a saved map to the state of a filter, and back.

#include <memory>
#include <optional>
#include <span>

#include <libslam/association/landmark_registry.hpp>
#include <libslam/map/saved_map.hpp>
#include <libslam/policy/excitation.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

/// How a filter starts in a map.
struct MapStart {
  std::shared_ptr<const SavedMap> map;  ///< passes check_saved_map
  /// Localization: the landmarks keep their estimates and covariances, which count in every
  /// innovation (Schmidt 1966), and none is added. Provisional landmarks of the map are left out.
  bool landmarks_given = false;
  /// Storage coordinates of the start pose in the frame of the map, independent of the map, with
  /// the covariance that the filter gives its start; nothing: the last pose of the map, with its
  /// covariance and cross-covariances.
  std::optional<BlockVector> pose;
  /// Take mean, covariance and cross-covariances of calibration parameters from the map, where it
  /// has them; else all have their priors. A random walk of a parameter does not go on between two
  /// runs.
  bool saved_calibration = true;
};

/// What a map speaks about in a filter.
struct MapBlocks {
  BlockId pose;
  std::span<const BlockId> calibration;
  BlockSpec landmark;  ///< of every landmark
};

/// Puts landmarks, pose, calibration and their joint covariance into a state that holds pose and
/// calibration so far, and the landmarks into `registry`. Parameters that the map does not have
/// keep their priors, those that the filter does not have are marginalized out. `excitation` goes
/// on where the map starts at its last pose and has the same parameters. Throws
/// std::invalid_argument if the map has landmarks of another kind or dimension, or no pose of this
/// kind although the start asks for one.
void enter_map(const MapStart& start, const MapBlocks& blocks, GaussianState& state,
               LandmarkRegistry& registry, Excitation& excitation);

/// The map of a filter in its present state: a filter that starts in it goes on as this one does.
SavedMap leave_map(const MapBlocks& blocks, const GaussianState& state,
                   const LandmarkRegistry& registry, const Excitation& excitation);

}  // namespace libslam
