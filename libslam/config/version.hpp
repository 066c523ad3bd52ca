#pragma once
// Which libslam this is: printed by `--version` and recorded in every run.

#include <string_view>

namespace libslam {

/// Release of the library, "major.minor.patch".
std::string_view version();

/// Short git revision of the sources at configure time; "unknown" outside a git checkout.
std::string_view git_revision();

}  // namespace libslam
