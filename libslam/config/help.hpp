#pragma once
// What `--help-config` prints and what config/README.md holds: the parameter table, for people.

#include <string>

namespace libslam {

/// Every key with default, domain and meaning as plain text of at most 100 columns.
std::string help_text();

/// The same as a Markdown page: the content of config/README.md.
std::string help_markdown();

}  // namespace libslam
