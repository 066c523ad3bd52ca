#pragma once
// What becomes of the settings of `kf-slam` that have no counterpart here.

#include <string>
#include <vector>

#include <mrpt/config/CConfigFileBase.h>

namespace libslam {

/// Appends one sentence for each key of `ini` that the loader does not follow, unless its value
/// asks for nothing (a switch that is off, an additional noise of 0). No key is passed over in
/// silence.
void append_remarks(const mrpt::config::CConfigFileBase& ini, std::vector<std::string>& notes);

}  // namespace libslam
