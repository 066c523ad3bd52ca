#pragma once
// What can go wrong in a simulated world, each on its own switch. None of it shows in the noise
// figures of the log.

#include <libslam/config/parameters.hpp>

namespace libslam {

/// Section `faults.outliers`.
struct OutlierParameters {
  bool enabled = false;
  double fraction = 0.05;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "Replace some measurements by nonsense."});
    v.value("fraction", fraction,
            {"1",
             "Probability that a measurement (sighting, beacon range, laser beam, pixel pair) is "
             "drawn uniformly from all that the sensor can report.",
             0, 1});
  }
};

/// Section `faults.noise_step`.
struct NoiseStepParameters {
  bool enabled = false;
  double begin_s = 60.0, end_s = 120.0;
  double factor = 3.0;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "Other sensor noise during a part of the time."});
    v.value("begin_s", begin_s, {"s", "Begin, since the start.", 0});
    v.value("end_s", end_s, {"s", "End, since the start.", 0});
    v.value("factor", factor, {"1", "Factor on the standard deviations of all sensors.", 0});
  }
};

/// Section `faults.distance_noise`.
struct DistanceNoiseParameters {
  bool enabled = false;
  double growth_per_m = 0.05;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "Sensor noise that grows with the distance."});
    v.value("growth_per_m", growth_per_m,
            {"1/m", "Standard deviations are multiplied by 1 + growth_per_m * distance.", 0});
  }
};

/// Section `faults.slip`.
struct SlipParameters {
  bool enabled = false;
  double rate_per_s = 0.02;
  double duration_s = 0.5;
  double travel_factor = 0.5;
  double turn_rate_deg_s = 0.0;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "Wheels slip now and then; the odometry does not notice."});
    v.value("rate_per_s", rate_per_s, {"1/s", "Mean number of slips per second of grip.", 0});
    v.value("duration_s", duration_s, {"s", "Length of a slip.", 0});
    v.value("travel_factor", travel_factor,
            {"1", "True travel during a slip per travel with grip.", 0});
    v.value("turn_rate_deg_s", turn_rate_deg_s,
            {"deg/s", "Turn during a slip, to a random side.", 0});
  }
};

/// Section `faults.kidnap`.
struct KidnapParameters {
  bool enabled = false;
  double time_s = 60.0;
  double forward = 3.0, left = 0.0, turn_deg = 20.0;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "Move the robot once, unseen by its odometry."});
    v.value("time_s", time_s, {"s", "When, since the start.", 0});
    v.value("forward", forward, {"m", "Displacement forward."});
    v.value("left", left, {"m", "Displacement to the left."});
    v.value("turn_deg", turn_deg, {"deg", "Turn, left positive."});
  }
};

/// Section `faults.moving_landmarks`.
struct MovingLandmarkParameters {
  bool enabled = false;
  double fraction = 0.1;
  double speed = 0.2;
  double distance = 5.0;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "Some landmarks go to and fro on straight lines."});
    v.value("fraction", fraction, {"1", "Probability that a landmark moves.", 0, 1});
    v.value("speed", speed, {"m/s", "Their speed.", 0});
    v.value("distance", distance, {"m", "Length of their lines.", 1e-6});
  }
};

/// Section `faults`.
struct FaultParameters {
  OutlierParameters outliers;
  NoiseStepParameters noise_step;
  DistanceNoiseParameters distance_noise;
  SlipParameters slip;
  KidnapParameters kidnap;
  MovingLandmarkParameters moving_landmarks;

  void describe(auto& v) {
    v.section("outliers", outliers);
    v.section("noise_step", noise_step);
    v.section("distance_noise", distance_noise);
    v.section("slip", slip);
    v.section("kidnap", kidnap);
    v.section("moving_landmarks", moving_landmarks);
  }
};

}  // namespace libslam
