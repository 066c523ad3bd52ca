#pragma once
// The building prior: every wall that is sure enough is told once that it is probably parallel to
// the others or at right angles to them.

#include <libslam/association/landmark_registry.hpp>
#include <libslam/filter/ekf.hpp>
#include <libslam/measurement/direction_prior.hpp>

namespace libslam {

struct BuildingPriorOptions {
  double sigma = 0.0;     ///< of DirectionPrior [rad]
  int min_sightings = 1;  ///< of a line before it is judged
  double min_length = 0;  ///< and its extent [m]
  double gate = 0.0;      ///< squared Mahalanobis distance beyond which a wall is oblique
};

/// The main direction is a block of the state that starts without knowledge.
class BuildingPrior {
 public:
  /// Throws std::invalid_argument unless sigma and gate are positive.
  explicit BuildingPrior(const BuildingPriorOptions& options);

  void add_to(GaussianState& state);
  /// Judges the lines that have become sure; each counts once, and not at all if it is oblique.
  void apply(GaussianState& state, Ekf& ekf, BlockId pose, LandmarkRegistry& registry);

  int judged() const { return judged_; }
  int oblique() const { return oblique_; }

 private:
  BuildingPriorOptions options_;
  DirectionPrior model_;
  BlockId direction_;
  LinearizedMeasurement measurement_;
  int judged_ = 0, oblique_ = 0;
};

}  // namespace libslam
