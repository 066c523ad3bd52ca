#pragma once
// From a saved map to the state of a filter, and back.

#include <memory>

#include <libslam/association/landmark_registry.hpp>
#include <libslam/filter/calibration_states.hpp>
#include <libslam/map/saved_map.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

/// How a filter starts in a map.
struct MapStart {
  std::shared_ptr<const SavedMap> map;  ///< passes check_saved_map
  /// Localization: the landmarks keep their estimates and covariances, which count in every
  /// innovation (Schmidt 1966), and none is added. Provisional landmarks of the map are left out.
  bool landmarks_given = false;
  /// The filter starts at the last pose of the map, with its covariance and cross-covariances; else
  /// at its own start pose, in the frame of the map and independent of it.
  bool at_saved_pose = true;
  /// Take mean, covariance and cross-covariances of calibration parameters from the map, where it
  /// has them; else all have their priors. A random walk of a parameter does not go on between two
  /// runs.
  bool saved_calibration = true;
};

/// The parts of a filter that a map speaks about.
struct MappedParts {
  GaussianState& state;
  BlockId pose;
  CalibrationStates& calibration;
  LandmarkRegistry& registry;
  BlockSpec landmark;  ///< of every landmark
};

/// Puts landmarks, pose, calibration and their joint covariance into a state that holds pose and
/// calibration so far, and the landmarks into the registry. Parameters that the map does not have
/// keep their priors, those that the filter does not have are marginalized out. The monitor of the
/// excitation goes on where the filter starts at the last pose with the same parameters. Throws
/// std::invalid_argument if the map has landmarks of another kind or dimension, or no pose of this
/// kind although the start asks for one.
void enter_map(const MapStart& start, MappedParts parts);

/// The map of a filter in its present state: a filter of the same parts that starts in it goes on
/// as this one does, but for what policies have adapted (noise, disturbances), which starts anew.
SavedMap leave_map(const GaussianState& state, BlockId pose, const CalibrationStates& calibration,
                   const LandmarkRegistry& registry, const BlockSpec& landmark);

}  // namespace libslam
