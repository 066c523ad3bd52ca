#pragma once
// Front-ends that look at pairs of images.

#include <string>

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `frontend.stereo`.
struct StereoFrontendParameters {
  std::string detector = "orb";
  std::string tracker = "descriptors";
  int detected = 1000;
  int delivered = 200;
  double sigma_pixel = 0.5;
  double row_tolerance = 2.0;
  double max_disparity = 128.0;
  double max_distance = 0.3;
  double distance_ratio = 0.9;
  int min_sightings = 2;
  int memory = 2;

  void describe(auto& v) {
    v.value("detector", detector,
            {"",
             "Detector and descriptor of the points; of klt only the descriptor: upright ORB, "
             "always.",
             0,
             0,
             {"orb", "akaze", "sift"}});
    v.value("tracker", tracker,
            {"",
             "How a point is found again in the next pair: by its descriptor, or corners by their "
             "surroundings (Lucas-Kanade).",
             0,
             0,
             {"descriptors", "klt"}});
    v.value("detected", detected,
            {"1", "Points sought in the left image, spread over it.", 8, 100000});
    v.value(
        "delivered", delivered,
        {"1", "Most features that one pair gives to the filter, oldest tracks first.", 1, 100000});
    v.value("sigma_pixel", sigma_pixel,
            {"px", "Standard deviation of each coordinate of a point in each image.", 1e-3, 100});
    v.value("row_tolerance", row_tolerance,
            {"px", "Largest difference between the rows of a point in the two images.", 0.1, 100});
    v.value("max_disparity", max_disparity,
            {"px", "Largest disparity: baseline x focal length / nearest depth.", 1, 10000});
    v.value("max_distance", max_distance,
            {"1",
             "Largest distance of two descriptors of one point: share of the bits (orb, akaze), "
             "or of the length of a descriptor (sift).",
             0, 1});
    v.value("distance_ratio", distance_ratio,
            {"1", "Best descriptor distance over second best, at most.", 0, 1});
    v.value("min_sightings", min_sightings,
            {"1",
             "Pairs in which a point must have been seen, in accordance with the motion of the "
             "camera, before the filter gets it; the first pair is exempt.",
             1, 100});
    v.value("memory", memory,
            {"1", "Pairs for which a track survives unseen (descriptors).", 0, 100});
  }
};

/// Section `frontend.fiducials`.
struct FiducialParameters {
  std::string family = "tag36h11";
  std::string points = "corners";
  double sigma_pixel = 0.3;
  double row_tolerance = 2.0;
  double decimate = 1.0;

  void describe(auto& v) {
    v.value("family", family,
            {"",
             "AprilTag families (tag...) and ArUco dictionaries (DICT_...).",
             0,
             0,
             {"tag36h11", "tag25h9", "tag16h5", "tagStandard41h12", "DICT_4X4_50", "DICT_4X4_250",
              "DICT_5X5_100", "DICT_6X6_250", "DICT_7X7_250", "DICT_ARUCO_ORIGINAL"}});
    v.value("points", points,
            {"",
             "Points of a tag that are landmarks: its centre, its four corners, or all five.",
             0,
             0,
             {"centre", "corners", "all"}});
    v.value("sigma_pixel", sigma_pixel,
            {"px", "Standard deviation of each coordinate of a corner in each image.", 1e-3, 100});
    v.value("row_tolerance", row_tolerance,
            {"px", "Largest difference between the rows of a point in the two images.", 0.1, 100});
    v.value("decimate", decimate,
            {"1", "Tags are sought in an image smaller by this factor (AprilTag).", 1, 8});
  }
};

}  // namespace libslam
