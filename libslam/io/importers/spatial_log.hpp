#pragma once
// A data set of a stereo camera in space, in memory, and how it becomes a standard MRPT rawlog.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/ground_truth.hpp>
#include <libslam/data/stereo_camera.hpp>

namespace libslam {

/// A point in both images.
struct StereoSighting {
  std::int64_t id = 0;
  Eigen::Vector4d pixels;  ///< left u, left v, right u, right v [px]
};

/// What happened up to one time.
struct SpatialStep {
  double time = 0.0;  ///< [s]
  /// vx, vy, vz [m/s], wx, wy, wz [rad/s] in the body frame since the step before.
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();
  std::vector<StereoSighting> sightings;
};

struct SpatialLog {
  std::string scenario;            ///< name of the data set and sequence
  std::vector<SpatialStep> steps;  ///< times increase
  StereoCamera camera;
  GroundTruth truth;
  std::map<std::string, double> parameters;    ///< of the data set, for the notes
  std::map<std::string, std::string> remarks;  ///< what a reader of the truth must know
};

/// Replaces every pixel by the projection of the true landmark from the true pose of its step plus
/// white noise with the standard deviations `sigma` (left u, left v, right u, right v [px]).
/// Sightings behind the camera, of unknown landmarks and in steps without a true pose are removed.
void simulate_pixels(SpatialLog& log, const Eigen::Vector4d& sigma, std::uint64_t seed);

/// Writes `rawlog` (X.rawlog, compressed): (action, frame) pairs, the first frame alone; the action
/// is a CActionRobotMovement3D with its velocities and the exact pose change, the frame holds one
/// CObservationStereoImagesFeatures. Beside it X.truth.json and, where known, X.truth.tum and
/// X.landmarks.csv; such files of an earlier import are removed. `interrupted`: see
/// write_imported_log. Throws std::runtime_error if a file cannot be written.
bool write_spatial_log(const SpatialLog& log, const std::string& rawlog,
                       const std::function<bool()>& interrupted = {});

}  // namespace libslam
