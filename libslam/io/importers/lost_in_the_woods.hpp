#pragma once
// "Lost in the Woods" of UTIAS: a robot among 17 tubes, wheel odometry and laser range-bearing at
// 10 Hz, Vicon truth (T. Barfoot, State Estimation for Robotics, data set 2).

#include <libslam/io/importers/imported_log.hpp>

namespace libslam {

/// `directory` holds odometry_and_groundtruth.csv, range_bearing.csv, landmarks.csv and params.txt,
/// each optionally with ".gz".
///
/// The input of row k moves the robot from pose k to pose k + 1: against the Vicon headings the
/// turn residual per step is 0.0067 rad so, 0.0088 rad with rows shifted by one. The laser sits d
/// ahead of the robot centre. Throws InputError.
ImportedLog import_lost_in_the_woods(const std::string& directory);

}  // namespace libslam
