#pragma once
// The still parts of the report: key figures, and drawings for a page without plotting
// library.

#include <string>

#include <nlohmann/json.hpp>

#include <libslam/result/run_summary.hpp>

namespace libslam {

/// Cards with the key figures of run.json, as HTML.
std::string key_figures_html(const RunSummary& summary);

/// Still SVG drawings of what make_report_data returns.
std::string still_drawings_html(const nlohmann::ordered_json& data);

/// One of its panels over `t`, with the name and unit of the abscissa in `axis`; empty without
/// values.
std::string still_panel_svg(const nlohmann::ordered_json& axis, const nlohmann::ordered_json& t,
                            const nlohmann::ordered_json& panel);

}  // namespace libslam
