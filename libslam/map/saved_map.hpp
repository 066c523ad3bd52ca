#pragma once
// A landmark map that outlives its run: what a filter needs to localize in it or to go on where the
// run ended.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/descriptor.hpp>
#include <libslam/data/extent.hpp>
#include <libslam/data/ground_truth.hpp>
#include <libslam/state/block.hpp>

namespace libslam {

/// A landmark in the order of the state.
struct SavedLandmark {
  std::int64_t id = 0;         ///< identity from the log, else a running number
  std::string type = "point";  ///< kind of landmark
  Eigen::VectorXd mean;        ///< in the frame of the map [m]
  int times_seen = 0;
  int updates = 0;        ///< of the filter since the landmark was added
  bool confirmed = true;  ///< false: still provisional
  bool exact = false;     ///< without error, and without rows in the covariance
  std::shared_ptr<const Descriptor> appearance;  ///< null: not known
  std::optional<Extent> extent = std::nullopt;   ///< of a line, all that was seen of it
  bool prior_judged = false;  ///< the building prior has counted it, or found it oblique
};

/// A calibration parameter at the end of the run.
struct SavedCalibration {
  std::string name;
  double mean = 0.0;  ///< in the unit of the parameter
};

/// One Gaussian over the last pose, the calibration and all landmarks. The covariance is that of
/// the additive error of the means (libslam/state/block.hpp), whatever the error frame of the
/// filter was. The cross-covariances between the landmarks are what makes the map better than its
/// worst landmark; those with the calibration tell a run that goes on how much of an error of the
/// map comes from the wheels; those with the pose matter to a run that starts where this one ended.
struct SavedMap {
  int dimension = 2;  ///< of the landmarks: 2 or 3
  BlockVector pose;   ///< last pose: x, y, phi or x, y, z, qx, qy, qz, qw; empty: the map has none
  std::vector<SavedCalibration> calibration;
  /// What the monitor of the excitation remembers (policy/excitation.hpp); empty: nothing.
  std::vector<double> excitation;
  std::vector<SavedLandmark> landmarks;
  std::int64_t next_number = 0;  ///< next running number for a landmark without identity
  Eigen::MatrixXd cov;           ///< pose, calibration, landmarks that are not exact; symmetric

  /// Rows of the covariance that belong to the pose: 0, 3 or 6.
  Eigen::Index pose_tangent() const;
  /// Rows before the first landmark.
  Eigen::Index landmark_offset() const;
  /// Rows that the covariance must have.
  Eigen::Index tangent() const;
};

/// A symmetric matrix of more rows than this is not factored in check_saved_map: it would take
/// longer than many runs.
inline constexpr Eigen::Index kLargestFactoredMap = 3000;

/// Throws std::invalid_argument with one line on the first thing that cannot be: sizes that do not
/// fit, an id twice, a type that is no plain word, a number that is not finite, a variance below
/// zero, a correlation beyond 1, or a covariance that is not positive semi-definite beyond rounding
/// (the last up to kLargestFactoredMap rows).
void check_saved_map(const SavedMap& map);

/// A map of landmarks whose places were measured by other means, each coordinate with the standard
/// deviation `sigma` [m], independent of all others; 0: known exactly. Throws std::invalid_argument
/// unless all positions have two or all have three coordinates, and as check_saved_map does.
SavedMap surveyed_map(const std::vector<TrueLandmark>& landmarks, double sigma);

}  // namespace libslam
