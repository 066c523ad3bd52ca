#pragma once
// What adapts the filter while it runs.

#include <libslam/config/description.hpp>
#include <libslam/config/parameters/disturbance.hpp>
#include <libslam/config/parameters/implied_input.hpp>
#include <libslam/config/parameters/noise_adaptation.hpp>
#include <libslam/config/parameters/update_schedule.hpp>

namespace libslam {

/// Section `policies`.
struct PolicyParameters {
  double update_period_s = 0.0;
  int update_every_n = 1;
  UpdateScheduleParameters update_schedule;
  NoiseAdaptationParameters noise_adaptation;
  ProcessAdaptationParameters process_adaptation;
  DisturbanceParameters disturbance;
  ImpliedInputParameters implied_input;

  void describe(auto& v) {
    v.value("update_period_s", update_period_s,
            {"s",
             "Shortest time between two updates; sensor errors of real logs are correlated in time "
             "and more frequent updates make the filter overconfident.",
             0});
    v.value("update_every_n", update_every_n, {"1", "Use every n-th observation frame only.", 1});
    v.section("update_schedule", update_schedule);
    v.section("noise_adaptation", noise_adaptation);
    v.section("process_adaptation", process_adaptation);
    v.section("disturbance", disturbance);
    v.section("implied_input", implied_input);
  }
};

}  // namespace libslam
