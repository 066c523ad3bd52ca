#pragma once
// MRPT's own range-bearing EKF-SLAM behind the calls that the benchmarks make.

#include <cstddef>
#include <string>

#include <Eigen/Core>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>

#include <libslam/data/log_step.hpp>

namespace libslam::bench {

/// `CRangeBearingKFSLAM2D` with the identities of the log, silent.
class MrptFilter {
 public:
  enum class Method { kDefault, kDavison };

  /// One sigma for all observations [m], [rad]: MRPT knows no others.
  MrptFilter(Method method, double sigma_range, double sigma_bearing);
  /// Settings of a `kf-slam` ini file but for the method.
  MrptFilter(Method method, const std::string& ini_file);

  /// `step` has an action and a frame with one CObservationBearingRange.
  void process(const LogStep& step);

  Eigen::Vector3d pose() const;
  /// Landmarks in the map; copies the state, so not for timed code.
  std::size_t landmarks() const;

 private:
  explicit MrptFilter(Method method);

  mrpt::slam::CRangeBearingKFSLAM2D filter_;
};

}  // namespace libslam::bench
