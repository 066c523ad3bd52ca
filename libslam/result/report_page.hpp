#pragma once
// A self-contained page: what the run's report and the campaign's report have in common.

#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace libslam {

/// Folder that holds d3/d3.min.js or d3.min.js: $LIBSLAM_JS_DIR, else the one found at
/// configuration.
std::filesystem::path plotting_library_folder();

/// What a page is made of. `title`, `source` and `program` are text; the rest is HTML, CSS, or
/// JavaScript that goes in as it is.
struct PageContent {
  std::string title, source, program;
  std::string cards;          ///< key figures
  std::string above, below;   ///< before and after the plots
  bool has_pictures = false;  ///< the page holds images as data
  std::string stills;         ///< in the place of the plots where the library is missing
  std::string style;          ///< beyond the common one
  std::string_view script;    ///< draws `data` into #plots with d3 and the parts of `reportParts`
  nlohmann::ordered_json data;
};

/// The page as HTML. The plotting library is read from `library_folder` and inlined; where it is
/// missing, the page carries the still drawings and says what to install. Nothing on the page
/// loads from a network.
std::string assemble_page(const PageContent& content, const std::filesystem::path& library_folder);

}  // namespace libslam
