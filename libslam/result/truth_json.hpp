#pragma once
// The `truth` part of run.json.

#include <nlohmann/json.hpp>

#include <libslam/result/truth_comparison.hpp>

namespace libslam {

/// Keys of absent figures are absent.
nlohmann::ordered_json truth_to_json(const TruthComparison& truth);

/// Throws nlohmann::json::exception where a key has the wrong type.
TruthComparison truth_from_json(const nlohmann::ordered_json& object);

}  // namespace libslam
