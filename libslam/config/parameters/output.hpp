#pragma once
// What a run writes.

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `output`.
struct OutputParameters {
  double trajectory_period_s = 0.0;
  bool report = true;
  bool mrpt_files = true;

  void describe(auto& v) {
    v.value("trajectory_period_s", trajectory_period_s,
            {"s",
             "Shortest time between two rows of the trajectory; rows with an update are always "
             "written.",
             0});
    v.value("report", report, {"", "Write report.html."});
    v.value("mrpt_files", mrpt_files, {"", "Write the files for MRPT's own tools."});
  }
};

}  // namespace libslam
