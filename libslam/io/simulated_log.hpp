#pragma once
// Writes a simulated drive as MRPT and libslam's programs read it: the log and its truth.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <mrpt/poses/CPose2D.h>
#include <nlohmann/json.hpp>

#include <libslam/data/ground_truth.hpp>
#include <libslam/data/log_step.hpp>

namespace mrpt::io {
class CFileGZOutputStream;
}
namespace mrpt::serialization {
class CArchive;
}

namespace libslam {

/// How steps become entries of a rawlog.
enum class LogFlavour {
  kPairs,         ///< an action and a frame per step; a step without frame gets an empty one
  kObservations,  ///< absolute odometry and observations one after another
};

/// The files of one drive: X.rawlog (compressed), X.truth.tum, X.truth.csv (`t,x,y,phi`),
/// X.landmarks.csv (`id,x,y[,z]`), X.truth.json. Streams with bounded memory, under temporary
/// names: the files appear in their places with `finish`.
class SimulatedLogWriter {
 public:
  /// `rawlog` is X.rawlog; `has_ticks`: the motions carry encoder ticks. Throws std::runtime_error
  /// where a file cannot be written.
  SimulatedLogWriter(const std::filesystem::path& rawlog, LogFlavour flavour, bool has_ticks);
  /// Removes what was not finished.
  ~SimulatedLogWriter();
  SimulatedLogWriter(const SimulatedLogWriter&) = delete;
  SimulatedLogWriter& operator=(const SimulatedLogWriter&) = delete;

  /// A step and the true pose (x [m], y [m], phi [rad]) at its end, world frame.
  void add(const LogStep& step, const Eigen::Vector3d& T_world_robot);

  /// Completes the files. `notes` becomes X.truth.json with `calibration` and `has_heading` added.
  void finish(const std::vector<TrueLandmark>& landmarks,
              const std::map<std::string, double>& calibration, nlohmann::ordered_json notes);

  std::int64_t steps() const { return steps_; }
  std::int64_t observations() const { return observations_; }

 private:
  void write_pair(const LogStep& step);
  void write_observations(const LogStep& step);
  void write_truth(double time, const Eigen::Vector3d& pose);

  std::filesystem::path rawlog_;
  LogFlavour flavour_;
  bool has_ticks_;
  std::unique_ptr<mrpt::io::CFileGZOutputStream> out_;
  std::unique_ptr<mrpt::serialization::CArchive> archive_;
  std::ofstream tum_, csv_;
  mrpt::poses::CPose2D odometry_;  ///< composed from the start
  Eigen::Array<std::int64_t, 2, 1> ticks_ = {0, 0};
  std::int64_t steps_ = 0, observations_ = 0;
};

}  // namespace libslam
