#pragma once
// What `--help-config` prints and what config/README.md holds: the parameter table, for people.

#include <string>
#include <string_view>

#include <libslam/config/parameter_table.hpp>

namespace libslam {

/// Every key with default, domain and meaning as plain text of at most 100 columns.
std::string help_text(const ParameterTable& table);
/// The same as Markdown: one heading and table per section, headings `level` deep.
std::string help_tables(const ParameterTable& table, int level = 2);

/// The keys of a run as plain text.
std::string help_text();
/// The keys of a run as a page with an introduction: the content of config/README.md.
std::string help_markdown();

}  // namespace libslam
