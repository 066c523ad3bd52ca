#pragma once
// A user's own log as CSV files. The first row of each file names its columns.
//
//   odometry.csv   t,x,y,phi                      absolute odometry pose [m, rad], or
//                  t,v,omega                      mean velocity since the row before [m/s, rad/s],
//                  or t,left_ticks,right_ticks       absolute encoder counters
//   landmarks.csv  t,id,range,bearing[,sigma_range,sigma_bearing]   [m, rad]; id -1: unknown
//   truth.csv      t,x,y[,phi]                    optional: true path
//
// Times are seconds and never go backwards; bearings count from the forward axis of the sensor,
// left positive.

#include <string>

#include <libslam/io/importers/imported_log.hpp>

namespace libslam {

struct CsvLogOptions {
  std::string odometry, landmarks;                           ///< files
  std::string truth;                                         ///< file, empty if there is none
  Eigen::Vector3d T_robot_sensor = Eigen::Vector3d::Zero();  ///< x [m], y [m], phi [rad]
  double metres_per_tick_left = 0.001, metres_per_tick_right = 0.001;
  double track_width = 0.5;  ///< [m], with ticks
};

/// Throws InputError "file:line: ...".
ImportedLog import_csv(const CsvLogOptions& options);

}  // namespace libslam
