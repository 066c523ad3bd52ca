#pragma once
// The files of assets/, embedded by CMake.

#include <string_view>

namespace libslam {

extern const std::string_view kReportPage;    ///< assets/report.html, with {{name}} where parts go
extern const std::string_view kReportStyle;   ///< assets/report.css
extern const std::string_view kReportParts;   ///< assets/report_parts.js, for all pages
extern const std::string_view kReportScript;  ///< assets/report.js, for the page of a run

}  // namespace libslam
