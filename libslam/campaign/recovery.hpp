#pragma once
// How long a filter takes to find back after a kidnap that the scenario knows of.

#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include <libslam/simulation/fault_parameters.hpp>

namespace libslam {

/// Recovered: the position error is below twice its mean over the `kLevelUpdates` updates before
/// the kidnap. A kidnap with fewer updates before it is not judged.
class Recovery {
 public:
  static constexpr std::size_t kLevelUpdates = 25;

  explicit Recovery(const KidnapParameters& kidnap) : kidnap_(kidnap) {}

  /// An update, `elapsed` [s] after the start, with its position error [m].
  void observe(double elapsed, double error);
  /// `updates` until recovered, if it has; `never`: 1 if not. Null: nothing to judge.
  nlohmann::ordered_json figures() const;

 private:
  KidnapParameters kidnap_;
  std::vector<double> before_;  // errors up to the kidnap
  double level_ = 0.0;
  int updates_ = 0;  // since the kidnap
  bool recovered_ = false;
};

}  // namespace libslam
