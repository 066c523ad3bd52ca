#pragma once
// A run in a few lines on the screen.

#include <filesystem>

#include <libslam/pipeline/run.hpp>

#include "console.hpp"

namespace libslam {

/// The result, how far it is from the truth, warnings, and where the report is.
void report(const RunSummary& summary, const std::filesystem::path& directory, Console& console);

/// Figures that say that the result should not be trusted.
void report_doubts(const RunSummary& summary, const GroundTruth& truth, Console& console);

/// What --verbose adds: where the time went and how the innovations behaved.
void report_details(const RunSummary& summary, Console& console);

}  // namespace libslam
