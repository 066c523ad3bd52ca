#pragma once
// Motion models and the noise of odometry.

#include <string>

#include <libslam/config/description.hpp>
#include <libslam/config/parameters/twist.hpp>

namespace libslam {

/// Noise of odometry. A variance is the sum of its parts: time (dt), distance (|ds|), turn
/// (|dphi|).
struct OdometryNoiseParameters {
  bool from_log = true;
  double along_per_sqrt_s = 0.0;
  double along_per_sqrt_m = 0.03;
  double along_per_sqrt_rad = 0.0;
  double across_per_sqrt_s = 0.0;
  double across_per_sqrt_m = 0.01;
  double turn_per_sqrt_s = 0.0;
  double turn_per_sqrt_m = 0.03;
  double turn_per_sqrt_rad = 0.06;
  double steering_per_sqrt_s = 0.0;

  void describe(auto& v) {
    v.value(
        "from_log", from_log,
        {"", "Use the covariance that the log gives with a pose increment, where it gives one."});
    v.value("along_per_sqrt_s", along_per_sqrt_s,
            {"m/sqrt(s)", "Forward noise that grows with time.", 0});
    v.value("along_per_sqrt_m", along_per_sqrt_m,
            {"m/sqrt(m)", "Forward noise that grows with distance.", 0});
    v.value("along_per_sqrt_rad", along_per_sqrt_rad,
            {"m/sqrt(rad)", "Forward noise that grows with turning.", 0});
    v.value("across_per_sqrt_s", across_per_sqrt_s,
            {"m/sqrt(s)", "Sideways noise that grows with time.", 0});
    v.value("across_per_sqrt_m", across_per_sqrt_m,
            {"m/sqrt(m)", "Sideways noise that grows with distance.", 0});
    v.value("turn_per_sqrt_s", turn_per_sqrt_s,
            {"rad/sqrt(s)", "Heading noise that grows with time.", 0});
    v.value("turn_per_sqrt_m", turn_per_sqrt_m,
            {"rad/sqrt(m)", "Heading noise that grows with distance.", 0});
    v.value("turn_per_sqrt_rad", turn_per_sqrt_rad,
            {"rad/sqrt(rad)", "Heading noise that grows with turning.", 0});
    v.value("steering_per_sqrt_s", steering_per_sqrt_s,
            {"rad*sqrt(s)",
             "White noise of the steering angle as a density: sigma of one reading times the "
             "square root of its period (ackermann).",
             0});
  }
};

/// Section `motion`.
struct MotionParameters {
  std::string model = "odometry_increment";
  std::string increment_form = "composition";
  double track_width = 0.5;
  double wheelbase = 2.83;
  double encoder_offset = 0.0;
  std::string ackermann_form = "rear_axle";
  double metres_per_tick_left = 0.001;
  double metres_per_tick_right = 0.001;
  double no_odometry_sigma_xy = 0.0;
  double no_odometry_sigma_heading_deg = 0.0;
  OdometryNoiseParameters noise;
  TwistParameters twist;
  ConstantTwistParameters constant_twist;

  void describe(auto& v) {
    v.value("model", model,
            {"",
             "Motion model of the robot; in space body_twist, which integrates body velocities, or "
             "constant_twist, which needs none.",
             0,
             0,
             {"odometry_increment", "differential", "ackermann", "body_twist", "constant_twist"}});
    v.value("increment_form", increment_form,
            {"",
             "How odometry_increment applies an increment: rigid-body composition, or an arc of "
             "length dD and turn dphi that ignores sideways motion.",
             0,
             0,
             {"composition", "arc"}});
    v.value("track_width", track_width,
            {"m",
             "Distance between the left and the right wheel; with pose increments only the virtual "
             "track through which they become wheel travel.",
             1e-6});
    v.value("wheelbase", wheelbase, {"m", "Distance between the axles (ackermann).", 1e-6});
    v.value("encoder_offset", encoder_offset,
            {"m",
             "Lateral position of the rear wheel that carries the encoder, left positive; 0: the "
             "axle centre (ackermann)."});
    v.value("ackermann_form", ackermann_form,
            {"",
             "Reference point of the ackermann pose: rear axle with tan, front axle with sin, or "
             "the mixed form of the seed paper (S1.4).",
             0,
             0,
             {"rear_axle", "front_axle", "seed"}});
    v.value("metres_per_tick_left", metres_per_tick_left,
            {"m", "Travel of the left wheel per encoder tick.", 0});
    v.value("metres_per_tick_right", metres_per_tick_right,
            {"m", "Travel of the right wheel per encoder tick.", 0});
    v.value("no_odometry_sigma_xy", no_odometry_sigma_xy,
            {"m", "Standard deviation added to x and y by a step without odometry.", 0});
    v.value("no_odometry_sigma_heading_deg", no_odometry_sigma_heading_deg,
            {"deg", "Standard deviation added to the heading by a step without odometry.", 0});
    v.section("noise", noise);
    v.section("twist", twist);
    v.section("constant_twist", constant_twist);
  }
};

}  // namespace libslam
