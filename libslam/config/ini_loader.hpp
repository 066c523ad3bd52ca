#pragma once
// The ini files of MRPT's stock `kf-slam` program.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <libslam/config/config_error.hpp>
#include <libslam/config/parameters.hpp>

namespace libslam {

/// What a `kf-slam` ini file says, in our terms.
///
/// The parameters reproduce `mrpt::slam::CRangeBearingKFSLAM2D` of MRPT 2.5.8 as far as it is
/// sound: pose increments of the log by composition with their own covariance, one configured
/// sensor sigma for all observations, standard error frame, exact start, identities of the log
/// without a gate, and nearest neighbour (by d^2 + log|S|) with one gate and no dead zone for
/// observations without identity. One difference remains: MRPT ignores motion before the first
/// landmark, here it counts. Sections of libslam (ini_parameters.hpp) are read on top.
struct KfSlamIni {
  Parameters parameters;
  /// Existing files as found from the folder of the ini file, else from the working directory; a
  /// rawlog that is at neither place stays as written.
  std::optional<std::string> rawlog_file, ground_truth_file, ground_truth_file_robot;
  std::string log_output_dir;      ///< empty if the file names none
  std::vector<std::string> notes;  ///< one sentence for each setting that is not followed exactly
};

/// Loads `path`. Throws ConfigError "file[:line]: ..." if it cannot be read, is no kf-slam ini
/// file, or a value is not what its key takes (MRPT itself reads such a value as 0).
KfSlamIni load_kf_slam_ini(const std::filesystem::path& path);

}  // namespace libslam
