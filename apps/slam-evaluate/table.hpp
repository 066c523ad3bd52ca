#pragma once
// The figures of several runs side by side.

#include <optional>
#include <string>
#include <vector>

#include <libslam/result/run_summary.hpp>

namespace libslam::evaluate {

struct EvaluatedRun {
  std::string name;
  RunSummary summary;  ///< `truth` holds the comparison
};

/// One figure of every run.
struct Figure {
  std::string key;                            ///< name in CSV, with unit
  std::string label;                          ///< name in the table, with unit
  std::vector<std::optional<double>> values;  ///< one per run
};

/// The figures that at least one run has; `detailed` adds those of second rank.
std::vector<Figure> figures_of(const std::vector<EvaluatedRun>& runs, bool detailed);

/// One column per run, aligned for a terminal.
std::string to_table(const std::vector<EvaluatedRun>& runs, const std::vector<Figure>& figures);

/// One line per run; numbers that read back exactly, empty cells where there is none.
std::string to_csv(const std::vector<EvaluatedRun>& runs, const std::vector<Figure>& figures);

/// {"runs": [{run, status, exit_code, landmarks, cpu_ms_per_step, truth}]} with the keys of
/// run.json in truth.
std::string to_json(const std::vector<EvaluatedRun>& runs);

}  // namespace libslam::evaluate
