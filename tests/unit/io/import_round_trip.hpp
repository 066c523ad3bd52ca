#pragma once
// A data set written as a rawlog and read back: what the tests of importers look at.

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <support/temporary_directory.hpp>
#include <vector>

#include <gtest/gtest.h>
#include <mrpt/poses/CPose2D.h>

#include <libslam/io/importers/imported_log.hpp>
#include <libslam/io/truth_reader.hpp>

#include "log_builder.hpp"

namespace libslam::test {

inline mrpt::poses::CPose2D pose(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

/// What a reader of the written rawlog sees.
struct Played {
  std::vector<LogStep> steps;
  std::vector<double> times;  ///< of the dead-reckoned poses
  std::vector<mrpt::poses::CPose2D> poses;
  GroundTruth truth;
  std::set<int> ids;
  std::size_t sightings = 0;
};

class ImportTest : public testing::Test {
 protected:
  std::string rawlog() const { return (directory_.path() / "x.rawlog").string(); }

  /// Writes the log, reads it back, and composes its odometry from the first true pose.
  Played round_trip(const ImportedLog& log) {
    EXPECT_TRUE(write_imported_log(log, rawlog()));
    RawlogPlayer player(rawlog(), with_policy("strict"));
    Played out;
    out.steps = play(player);
    out.truth = read_truth(find_truth(rawlog()));
    mrpt::poses::CPose2D at =
        out.truth.path.poses.empty() ? mrpt::poses::CPose2D() : pose(out.truth.path.poses.front());
    for (const LogStep& step : out.steps) {
      if (const auto motion = motion_of(step)) at = at + motion->rawOdometryIncrementReading;
      out.times.push_back(step.time);
      out.poses.push_back(at);
      if (!step.frame) continue;
      const auto seen = step.frame->getObservationByClass<mrpt::obs::CObservationBearingRange>();
      out.sightings += seen->sensedData.size();
      for (const auto& m : seen->sensedData) out.ids.insert(m.landmarkID);
    }
    return out;
  }

  /// Distance of the dead-reckoned poses to the nearest truth within `window` [s].
  static std::vector<double> path_errors(const Played& played, double window) {
    std::vector<double> errors;
    const auto& truth = played.truth.path;
    for (std::size_t i = 0; i < played.times.size(); ++i) {
      const auto after =
          std::lower_bound(truth.times.begin(), truth.times.end(), played.times[i] - window);
      if (after == truth.times.end() || *after > played.times[i] + window) continue;
      const auto& t = truth.poses[static_cast<std::size_t>(after - truth.times.begin())];
      errors.push_back(std::hypot(played.poses[i].x() - t.x(), played.poses[i].y() - t.y()));
    }
    return errors;
  }

  static double rms(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double v : values) sum += v * v;
    return std::sqrt(sum / static_cast<double>(values.size()));
  }

  TemporaryDirectory directory_;
};

}  // namespace libslam::test
