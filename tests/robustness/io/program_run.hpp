#pragma once
// The programs under test here.

#include <string>
#include <support/program_run.hpp>

namespace libslam::test {

inline const std::string kPlay = LIBSLAM_SLAM_PLAY, kImport = LIBSLAM_SLAM_IMPORT;

}  // namespace libslam::test
