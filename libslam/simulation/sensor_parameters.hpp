#pragma once
// Parameters of simulated sensors and of what can go wrong with them.

#include <libslam/config/parameters.hpp>

namespace libslam {

/// Where a sensor sits on the robot, as the log says; `truth.sensor_*` moves the real one.
struct SensorPoseParameters {
  double x = 0.0, y = 0.0, heading_deg = 0.0;

  void describe(auto& v) {
    v.value("x", x, {"m", "Forward of the robot's reference point."});
    v.value("y", y, {"m", "To the left of it."});
    v.value("heading_deg", heading_deg, {"deg", "Direction of the sensor, left positive."});
  }
};

/// Section `range_bearing`.
struct RangeBearingSensorParameters {
  bool enabled = true;
  double sigma_range = 0.2;
  double sigma_bearing_deg = 2.0;
  double max_range = 30.0;
  double field_of_view_deg = 180.0;
  SensorPoseParameters pose;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "The robot sees range and bearing of landmarks."});
    v.value("sigma_range", sigma_range, {"m", "Standard deviation of a range.", 0});
    v.value("sigma_bearing_deg", sigma_bearing_deg, {"deg", "Standard deviation of a bearing.", 0});
    v.value("max_range", max_range, {"m", "Farther landmarks are not seen.", 1e-6});
    v.value("field_of_view_deg", field_of_view_deg,
            {"deg", "Full opening angle, centred on the direction of the sensor.", 1e-3, 360});
    v.section("pose", pose);
  }
};

/// Section `beacons`.
struct BeaconSensorParameters {
  bool enabled = false;
  double sigma_range = 0.1;
  double max_range = 50.0;
  double antenna_height = 0.0;
  SensorPoseParameters pose;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "Landmarks are radio beacons too: ranges without bearings."});
    v.value("sigma_range", sigma_range, {"m", "Standard deviation of a range.", 0});
    v.value("max_range", max_range, {"m", "Farther beacons are not heard.", 1e-6});
    v.value("antenna_height", antenna_height, {"m", "Height of the antenna above the ground."});
    v.section("pose", pose);
  }
};

/// Section `laser`.
struct LaserSensorParameters {
  bool enabled = false;
  int beams = 1081;
  double aperture_deg = 270.0;
  double max_range = 30.0;
  double sigma_range = 0.01;
  SensorPoseParameters pose;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "A 2-D laser sees walls and round trunks."});
    v.value("beams", beams, {"1", "Beams of one scan.", 2, 100000});
    v.value("aperture_deg", aperture_deg,
            {"deg", "Angle from the first to the last beam.", 1, 360});
    v.value("max_range", max_range, {"m", "Beams that meet nothing nearer are invalid.", 1e-6});
    v.value("sigma_range", sigma_range, {"m", "Standard deviation of a range.", 0});
    v.section("pose", pose);
  }
};

/// Section `stereo`: two rectified pinhole cameras that look along the direction of the sensor.
struct StereoSensorParameters {
  bool enabled = false;
  double focal_length_px = 500.0;
  int width = 640, height = 480;
  double baseline = 0.2;
  double sigma_pixel = 0.5;
  double max_range = 20.0;
  double camera_height = 1.0;
  SensorPoseParameters pose;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "A stereo camera sees landmarks as pairs of pixels."});
    v.value("focal_length_px", focal_length_px, {"px", "Focal length.", 1});
    v.value("width", width, {"px", "Width of the images; the axis meets their centre.", 1, 100000});
    v.value("height", height, {"px", "Height of the images.", 1, 100000});
    v.value("baseline", baseline, {"m", "Right camera to the right of the left one.", 1e-6});
    v.value("sigma_pixel", sigma_pixel,
            {"px", "Standard deviation of each of the four coordinates.", 0});
    v.value("max_range", max_range, {"m", "Landmarks farther along the axis are not seen.", 1e-6});
    v.value("camera_height", camera_height, {"m", "Height of the cameras above the ground."});
    v.section("pose", pose);
  }
};

/// Section `stereo_images`: a rendered pair of gray images of floor, walls, ceiling and tags.
struct StereoImagesParameters {
  bool enabled = false;
  double focal_length_px = 260.0;
  int width = 320, height = 240;
  double baseline = 0.12;
  double camera_height = 1.0;
  double wall_height = 2.5;
  double tag_size = 0.4;
  double sigma_gray = 2.0;
  SensorPoseParameters pose;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "A stereo camera takes images; landmarks carry tags."});
    v.value("focal_length_px", focal_length_px, {"px", "Focal length.", 1});
    v.value("width", width, {"px", "Width of the images; the axis meets their centre.", 16, 4096});
    v.value("height", height, {"px", "Height of the images.", 16, 4096});
    v.value("baseline", baseline, {"m", "Right camera to the right of the left one.", 1e-6});
    v.value("camera_height", camera_height,
            {"m", "Height of the cameras above the floor, below that of the walls.", 1e-3});
    v.value("wall_height", wall_height,
            {"m", "Height of walls and ceiling; without walls the sky is open.", 1e-3});
    v.value("tag_size", tag_size,
            {"m", "Side of the black border of the tags (tag36h11) at landmarks 0 to 586.", 1e-3});
    v.value("sigma_gray", sigma_gray, {"1", "Standard deviation of a gray value of 255.", 0, 255});
    v.section("pose", pose);
  }
};

}  // namespace libslam
