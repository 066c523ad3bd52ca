#pragma once
// A run beside the batch optimum on its log.

#include <filesystem>
#include <string>
#include <vector>

#include <libslam/batch/batch_comparison.hpp>
#include <libslam/result/run_summary.hpp>

namespace libslam::evaluate {

struct BatchEvaluation {
  std::string name;
  BatchComparison comparison;
  double seconds = 0.0;  ///< of all optimizations
};

/// Repeats the run in `directory`, solves it as a whole and writes batch.json there; with
/// `on_line_steps` also solves the log up to each of so many steps. Throws
/// std::runtime_error where the log is not the one of the run or something cannot be read, solved
/// or written.
BatchEvaluation evaluate_batch(const std::filesystem::path& directory, const std::string& name,
                               const RunSummary& summary, const GroundTruth& truth,
                               int on_line_steps);

/// The figures of filter and batch side by side, their distance and what the solver did.
std::string to_text(const BatchEvaluation& run, bool detailed);

/// {"runs": [{run, filter, batch, distance, optimization, timing}]} with the keys of batch.json.
std::string to_json(const std::vector<BatchEvaluation>& runs);

}  // namespace libslam::evaluate
