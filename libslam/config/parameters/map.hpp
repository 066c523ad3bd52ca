#pragma once
// A map of an earlier run, or a surveyed one, to start in.

#include <string>

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `map`.
struct MapParameters {
  std::string file;
  std::string mode = "localize";
  std::string start = "saved_pose";
  double initial_x = 0.0;
  double initial_y = 0.0;
  double initial_heading_deg = 0.0;
  double initial_z = 0.0;
  double initial_pitch_deg = 0.0;
  double initial_roll_deg = 0.0;
  double sigma = 0.0;
  std::string calibration = "saved";

  void describe(auto& v) {
    v.value("file", file,
            {"",
             "Map to start in, the same as --load-map: one that --save-map wrote, or surveyed "
             "landmarks (id,x,y[,z]); empty: none."});
    v.value("mode", mode,
            {"",
             "localize: the landmarks are given, count with their uncertainty, do not move, and no "
             "new ones are added; continue: SLAM goes on in the map.",
             0,
             0,
             {"localize", "continue"}});
    v.value("start", start,
            {"",
             "saved_pose: where the run that saved the map ended, with everything it knew; "
             "given_pose: at initial_x, initial_y, initial_heading_deg with the uncertainty of "
             "filter.initial_sigma_xy and filter.initial_sigma_heading_deg.",
             0,
             0,
             {"saved_pose", "given_pose"}});
    v.value("initial_x", initial_x, {"m", "Start position in the frame of the map (given_pose)."});
    v.value("initial_y", initial_y, {"m", "Start position in the frame of the map (given_pose)."});
    v.value("initial_heading_deg", initial_heading_deg,
            {"deg", "Start heading in the frame of the map (given_pose)."});
    v.value("initial_z", initial_z, {"m", "Start height of a robot in space (given_pose)."});
    v.value("initial_pitch_deg", initial_pitch_deg,
            {"deg", "Start pitch of a robot in space, nose down positive (given_pose)."});
    v.value("initial_roll_deg", initial_roll_deg,
            {"deg", "Start roll of a robot in space, right side down positive (given_pose)."});
    v.value("sigma", sigma,
            {"m",
             "Standard deviation of each coordinate of a surveyed landmark; 0: known exactly, "
             "which costs nothing in the covariance.",
             0});
    v.value("calibration", calibration,
            {"",
             "saved: calibration parameters go on from the map, for the same robot; prior: they "
             "start anew.",
             0,
             0,
             {"saved", "prior"}});
  }
};

}  // namespace libslam
