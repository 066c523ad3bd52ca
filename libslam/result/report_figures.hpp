#pragma once
// The still parts of the report: key figures, warnings, and drawings for a page without plotting
// library.

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <libslam/result/run_summary.hpp>

namespace libslam {

/// `text` with the five characters that HTML gives a meaning replaced.
std::string escape_html(std::string_view text);

/// Cards with the key figures of run.json, as HTML.
std::string key_figures_html(const RunSummary& summary);

/// The warnings as a list; empty without any.
std::string warnings_html(const RunSummary& summary);

/// Still SVG drawings of what make_report_data returns.
std::string still_drawings_html(const nlohmann::ordered_json& data);

}  // namespace libslam
