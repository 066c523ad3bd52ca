#pragma once
// report.html: one self-contained page that shows a run.

#include <filesystem>
#include <span>
#include <string>

#include <libslam/data/ground_truth.hpp>
#include <libslam/map/landmark_map.hpp>
#include <libslam/result/report_page.hpp>
#include <libslam/result/report_picture.hpp>
#include <libslam/result/run_summary.hpp>
#include <libslam/result/series_envelope.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {

/// What the page shows. The references must outlive the call of make_report.
struct ReportInput {
  const RunSummary& summary;
  const LandmarkMap& map;
  PathView path;
  std::filesystem::path trajectory_csv;  ///< read once more for innovations and calibration
  const GroundTruth& truth;              ///< may be empty
  const SeriesEnvelope& step_times;      ///< [ms] over the number of the step
  std::span<const ReportPicture> pictures{};
  const Trajectory* smoothed = nullptr;  ///< the path as it was known at the end, in the plane
};

/// The page as HTML, see assemble_page. Throws like TrajectoryReader.
std::string make_report(const ReportInput& input,
                        const std::filesystem::path& library_folder = plotting_library_folder());

}  // namespace libslam
