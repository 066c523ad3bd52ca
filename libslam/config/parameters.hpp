#pragma once
// Every parameter of a run: its default, unit, range and one sentence, in one place.
//
// Each struct describes itself to a visitor; the YAML loader, `--help-config`, `--set`, the
// effective configuration and config/README.md are all visits of the same description.

#include <string>

#include <libslam/config/description.hpp>

namespace libslam {

inline constexpr double kPi = 3.141592653589793;

/// Section `input`: what is read from the log.
struct InputParameters {
  std::string policy = "skip";
  std::string odometry = "auto";
  std::string odometry_label = "";
  std::string sensor_label = "";
  double velocity_tolerance = 0.2;

  void describe(auto& v) {
    v.value("policy", policy,
            {"",
             "What to do with an unusable entry of the log: stop, leave it out, or mend what can "
             "be mended.",
             0,
             0,
             {"strict", "skip", "repair"}});
    v.value("odometry", odometry,
            {"",
             "Field of the log that drives the motion model; auto takes pose increments; none "
             "ignores odometry.",
             0,
             0,
             {"auto", "increments", "velocities", "ticks", "none"}});
    v.value("odometry_label", odometry_label,
            {"", "Use only odometry observations with this sensor label; empty: all."});
    v.value("sensor_label", sensor_label,
            {"", "Use only landmark observations with this sensor label; empty: all."});
    v.value("velocity_tolerance", velocity_tolerance,
            {"1",
             "Velocities or ticks of the log are used only if, over the first readings, they agree "
             "with its pose increments within this fraction.",
             0, 10});
  }
};

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

  void describe(auto& v) {
    v.value("model", model,
            {"",
             "Motion model of the robot.",
             0,
             0,
             {"odometry_increment", "differential", "ackermann"}});
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
  }
};

/// One calibration parameter of the state.
struct CalibrationParameter {
  bool enabled = false;
  double prior_mean = 1.0;
  double prior_sigma = 0.1;
  double random_walk_per_sqrt_s = 0.0;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "Estimate this parameter as a block of the state."});
    v.value("prior_mean", prior_mean,
            {"", "Value before any data; used as a constant when not enabled."});
    v.value("prior_sigma", prior_sigma, {"", "Standard deviation of the prior.", 1e-12});
    v.value("random_walk_per_sqrt_s", random_walk_per_sqrt_s,
            {"1/sqrt(s)", "Random walk of the parameter.", 0});
  }
};

/// Section `calibration`: odometry parameters, and the pose (x, y [m], phi [rad]) of a sensor that
/// measures displacements, as state.
struct CalibrationParameters {
  CalibrationParameter scale_left, scale_right;
  CalibrationParameter track_width{false, 1.0, 0.1, 0.0};
  CalibrationParameter scale_speed, scale_steering;
  CalibrationParameter bias_steering{false, 0.0, 0.02, 0.0};
  CalibrationParameter sensor_x{false, 0.0, 0.05, 0.0}, sensor_y{false, 0.0, 0.05, 0.0};
  CalibrationParameter sensor_phi{false, 0.0, 0.1, 0.0};

  void describe(auto& v) {
    v.section("scale_left", scale_left);
    v.section("scale_right", scale_right);
    v.section("track_width", track_width);
    v.section("scale_speed", scale_speed);
    v.section("scale_steering", scale_steering);
    v.section("bias_steering", bias_steering);
    v.section("sensor_x", sensor_x);
    v.section("sensor_y", sensor_y);
    v.section("sensor_phi", sensor_phi);
  }
};

/// Section `frontend`.
struct FrontendParameters {
  std::string source = "range_bearing";
  double min_range = 0.0;
  double max_range = 1e6;

  void describe(auto& v) {
    v.value("source", source,
            {"",
             "Where features come from: range-bearing observations, or the path that a sensor "
             "reports of itself (odometry observations labelled input.sensor_label).",
             0,
             0,
             {"range_bearing", "sensor_path"}});
    v.value("min_range", min_range, {"m", "Nearer observations are ignored.", 0});
    v.value("max_range", max_range, {"m", "Farther observations are ignored.", 0});
  }
};

/// Section `measurement`.
struct MeasurementParameters {
  std::string model = "range_bearing";
  std::string noise = "auto";
  double sigma_range = 0.1;
  double sigma_bearing_deg = 1.0;
  double sigma_displacement_xy = 0.001;
  double sigma_displacement_heading_deg = 0.1;

  void describe(auto& v) {
    v.value("model", model,
            {"",
             "Measurement model: of landmarks, or of the displacement of a sensor (no map).",
             0,
             0,
             {"range_bearing", "sensor_displacement"}});
    v.value(
        "noise", noise,
        {"",
         "Noise of an observation: per-observation covariance of the log where it has one, the "
         "log's sensor sigmas, else the configured sigmas (auto), or always the configured ones.",
         0,
         0,
         {"auto", "configured"}});
    v.value("sigma_range", sigma_range, {"m", "Standard deviation of a range.", 1e-9});
    v.value("sigma_bearing_deg", sigma_bearing_deg,
            {"deg", "Standard deviation of a bearing.", 1e-9});
    v.value("sigma_displacement_xy", sigma_displacement_xy,
            {"m", "Standard deviation of a sensor's displacement along x and y, each.", 1e-9});
    v.value("sigma_displacement_heading_deg", sigma_displacement_heading_deg,
            {"deg", "Standard deviation of the turn of a displacement.", 1e-9});
  }
};

/// Section `association`.
struct AssociationParameters {
  std::string method = "known";
  double gate_probability = 0.99;
  double new_landmark_probability = 0.999;
  int confirm_after = 1;
  int prune_after = 0;

  void describe(auto& v) {
    v.value("method", method,
            {"",
             "known: identities of the log; nearest_neighbour: identities are ignored; "
             "known_or_nearest: identities of the log without a gate, nearest neighbour for "
             "observations that have none.",
             0,
             0,
             {"known", "nearest_neighbour", "known_or_nearest"}});
    v.value("gate_probability", gate_probability,
            {"1",
             "An observation is accepted as a sighting of a landmark if its squared Mahalanobis "
             "distance is below this chi-square probability; 1 accepts all.",
             0, 1});
    v.value(
        "new_landmark_probability", new_landmark_probability,
        {"1",
         "An observation starts a new landmark only if it is beyond this chi-square probability of "
         "every landmark; in between it is dropped as ambiguous (nearest_neighbour).",
         0, 1});
    v.value("confirm_after", confirm_after,
            {"1", "Sightings after which a landmark counts as confirmed.", 1});
    v.value("prune_after", prune_after,
            {"1", "A landmark that is not confirmed within this many updates is removed; 0: never.",
             0});
  }
};

/// Section `filter`.
struct FilterParameters {
  std::string error_frame = "right_invariant";
  std::string linearization = "estimate";
  double initial_sigma_xy = 0.0;
  double initial_sigma_heading_deg = 0.0;

  void describe(auto& v) {
    v.value("error_frame", error_frame,
            {"", "Error that the covariance describes.", 0, 0, {"standard", "right_invariant"}});
    v.value(
        "linearization", linearization,
        {"",
         "Where derivatives are taken: at the estimate, at the first estimates of landmarks and "
         "the predicted pose, or at the truth (simulations only).",
         0,
         0,
         {"estimate", "first_estimate", "at_truth"}});
    v.value("initial_sigma_xy", initial_sigma_xy,
            {"m", "Standard deviation of the start position.", 0});
    v.value("initial_sigma_heading_deg", initial_sigma_heading_deg,
            {"deg", "Standard deviation of the start heading.", 0});
  }
};

/// Section `policies`.
struct PolicyParameters {
  double update_period_s = 0.0;
  int update_every_n = 1;

  void describe(auto& v) {
    v.value("update_period_s", update_period_s,
            {"s",
             "Shortest time between two updates; sensor errors of real logs are correlated in time "
             "and more frequent updates make the filter overconfident.",
             0});
    v.value("update_every_n", update_every_n, {"1", "Use every n-th observation frame only.", 1});
  }
};

/// Section `output`.
struct OutputParameters {
  double trajectory_period_s = 0.0;
  bool report = true;
  bool mrpt_files = true;

  void describe(auto& v) {
    v.value("trajectory_period_s", trajectory_period_s,
            {"s",
             "Shortest time between two rows of the trajectory; rows with an update are always "
             "written.",
             0});
    v.value("report", report, {"", "Write report.html."});
    v.value("mrpt_files", mrpt_files, {"", "Write the files for MRPT's own tools."});
  }
};

/// A complete run.
struct Parameters {
  InputParameters input;
  MotionParameters motion;
  CalibrationParameters calibration;
  FrontendParameters frontend;
  MeasurementParameters measurement;
  AssociationParameters association;
  FilterParameters filter;
  PolicyParameters policies;
  OutputParameters output;

  void describe(auto& v) {
    v.section("input", input);
    v.section("motion", motion);
    v.section("calibration", calibration);
    v.section("frontend", frontend);
    v.section("measurement", measurement);
    v.section("association", association);
    v.section("filter", filter);
    v.section("policies", policies);
    v.section("output", output);
  }
};

}  // namespace libslam
