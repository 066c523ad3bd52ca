// slam-play: what is in a rawlog; played as fast as possible, in time, or step by step.

#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <nlohmann/json.hpp>

#include <libslam/io/log_inspection.hpp>
#include <libslam/io/rawlog_player.hpp>

#include "../program/program.hpp"

namespace {

using namespace libslam;

struct Arguments {
  std::string file, policy = "skip";
  double speed = 0.0;
  bool step = false, json = false, quiet = false, verbose = false;
};

std::string describe(const LogStep& step) {
  char text[160];
  std::snprintf(text, sizeof(text), "%8lld  t %.6f", static_cast<long long>(step.index), step.time);
  std::string line = text;
  const auto motion =
      step.action ? step.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>() : nullptr;
  if (motion) {
    mrpt::poses::CPose2D d;
    motion->poseChange->getMean(d);
    std::snprintf(text, sizeof(text), "  moved %+.4f %+.4f m %+.5f rad in %.4f s", d.x(), d.y(),
                  d.phi(), step.dt);
    line += text;
  }
  const auto spatial =
      step.action ? step.action->getActionByClass<mrpt::obs::CActionRobotMovement3D>() : nullptr;
  if (spatial) {
    const mrpt::poses::CPose3D& d = spatial->poseChange.mean;
    std::snprintf(text, sizeof(text),
                  "  moved %+.4f %+.4f %+.4f m, yaw pitch roll %+.5f %+.5f %+.5f rad in %.4f s",
                  d.x(), d.y(), d.z(), d.yaw(), d.pitch(), d.roll(), step.dt);
    line += text;
  }
  if (!step.frame) return line;
  for (const auto& observation : *step.frame)
    line += std::string("  ") + observation->GetRuntimeClass()->className + " '" +
            observation->sensorLabel + "'";
  return line;
}

void print_text(const LogInspection& log, const RawlogPlayer& player) {
  const InputSummary& input = player.summary();
  std::printf("flavour      %s%s\n",
              player.is_pair_log() ? "(action, frame) pairs" : "observations one after another",
              input.leading_frame ? ", observations before the first motion" : "");
  std::printf("entries      %lld, steps %lld\n", static_cast<long long>(input.entries),
              static_cast<long long>(log.steps()));
  std::printf("time         %.6f .. %.6f, %.3f s\n", log.first_time(), log.last_time(),
              input.duration_s);
  for (const auto& [name, count] : log.classes())
    std::printf("class        %-40s %9lld\n", name.c_str(), static_cast<long long>(count));
  for (const auto& [name, s] : log.sensors())
    std::printf(
        "sensor       %-40s %9lld  %8.3f Hz, longest gap %.3f s, times invalid %lld, backwards "
        "%lld\n",
        name.c_str(), static_cast<long long>(s.count), s.rate(), s.longest_gap,
        static_cast<long long>(s.invalid_times), static_cast<long long>(s.backward_times));
  const OdometryStatistics& o = log.odometry();
  std::printf(
      "odometry     %lld motions, %.3f m, turned %.3f rad, fastest %.3f m/s and %.3f rad/s\n",
      static_cast<long long>(o.motions), o.path_length, o.total_turn, o.max_speed, o.max_turn_rate);
  std::printf(
      "             with covariance %lld, with velocities %lld (%lld agree), with ticks %lld\n",
      static_cast<long long>(o.with_covariance), static_cast<long long>(o.with_velocities),
      static_cast<long long>(o.velocities_agree), static_cast<long long>(o.with_ticks));
  const LandmarkStatistics& l = log.landmarks();
  if (l.sightings > 0)
    std::printf(
        "landmarks    %lld sightings, %lld identified (%zu identities), %lld unusable, range %.3f "
        ".. %.3f m\n",
        static_cast<long long>(l.sightings), static_cast<long long>(l.with_identity),
        l.identities.size(), static_cast<long long>(l.unusable), l.min_range, l.max_range);
  std::printf("input        skipped %lld, repaired %lld%s\n", static_cast<long long>(input.skipped),
              static_cast<long long>(input.repaired), input.damaged ? ", damaged" : "");
}

void print_json(const LogInspection& log, const RawlogPlayer& player) {
  const InputSummary& input = player.summary();
  const OdometryStatistics& o = log.odometry();
  const LandmarkStatistics& l = log.landmarks();
  nlohmann::json json;
  json["flavour"] = player.is_pair_log() ? "pairs" : "observations";
  json["leading_frame"] = input.leading_frame;
  json["steps"] = log.steps();
  json["time"] = {{"first", log.first_time()}, {"last", log.last_time()}};
  json["input"] = {{"entries", input.entries},
                   {"actions", input.actions},
                   {"observations", input.observations},
                   {"duration_s", input.duration_s},
                   {"skipped", input.skipped},
                   {"repaired", input.repaired},
                   {"damaged", input.damaged},
                   {"warnings", input.warnings},
                   {"warnings_omitted", input.warnings_omitted}};
  json["classes"] = log.classes();
  for (const auto& [name, s] : log.sensors())
    json["sensors"][name] = {{"count", s.count},
                             {"rate_hz", s.rate()},
                             {"longest_gap_s", s.longest_gap},
                             {"invalid_times", s.invalid_times},
                             {"backward_times", s.backward_times}};
  json["odometry"] = {{"motions", o.motions},
                      {"path_length_m", o.path_length},
                      {"total_turn_rad", o.total_turn},
                      {"max_speed_m_s", o.max_speed},
                      {"max_turn_rate_rad_s", o.max_turn_rate},
                      {"with_covariance", o.with_covariance},
                      {"with_velocities", o.with_velocities},
                      {"velocities_agree", o.velocities_agree},
                      {"with_ticks", o.with_ticks}};
  json["landmarks"] = {{"sightings", l.sightings},          {"identified", l.with_identity},
                       {"identities", l.identities.size()}, {"unusable", l.unusable},
                       {"min_range_m", l.min_range},        {"max_range_m", l.max_range}};
  // Labels come from the file: what is no UTF-8 in them must not stop the output.
  std::cout << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

PlayerOptions player_options(const Arguments& arguments, LogInspection& log) {
  PlayerOptions options;
  options.input.policy = arguments.policy;
  options.on_entry = [&log](const RawlogEntry& entry) { log.observe(entry); };
  if (arguments.speed > 0.0) {
    options.pacing.mode = PaceMode::kRealTime;
    options.pacing.factor = arguments.speed;
  }
  const std::atomic<bool>& stop = stop_on_signals();
  options.pacing.before_step = [&stop](const LogStep&) { return !stop; };
  if (arguments.step) {
    options.pacing.mode = PaceMode::kStep;
    options.pacing.before_step = [&stop](const LogStep& step) {
      std::cout << describe(step) << std::endl;
      std::string line;
      return !stop && std::getline(std::cin, line) && line != "q";
    };
  }
  return options;
}

int play(const Arguments& arguments) {
  LogInspection log;
  RawlogPlayer player(arguments.file, player_options(arguments, log));
  const bool narrate =
      arguments.verbose || (arguments.speed > 0.0 && !arguments.quiet && !arguments.json);
  while (const auto step = player.next()) {
    log.observe(*step);
    if (narrate && !arguments.step) std::cout << describe(*step) << '\n' << std::flush;
  }
  if (arguments.json)
    print_json(log, player);
  else if (!arguments.quiet)
    print_text(log, player);
  const InputSummary& input = player.summary();
  if (!arguments.quiet)
    for (const auto& warning : input.warnings) std::cerr << "slam-play: " << warning << '\n';
  if (!arguments.quiet && input.warnings_omitted > 0)
    std::cerr << "slam-play: " << input.warnings_omitted << " further warnings\n";
  if (stop_on_signals()) return kInterrupted;
  return input.incomplete() ? kIncomplete : kDone;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Shows what is in a rawlog and plays it.", "slam-play"};
  app.set_version_flag("--version", version_line("slam-play"));
  app.footer(
      "Example:\n  slam-play /usr/share/mrpt/datasets/kf-slam_demo.rawlog\n"
      "Exit codes: 0 sound, 2 command line, 4 rejected, 5 partly unusable, 7 interrupted.");
  app.add_option("file", arguments.file, "Rawlog, compressed or not")->required();
  app.add_option("--input-policy", arguments.policy, "What to do with unusable entries")
      ->check(CLI::IsMember({"strict", "skip", "repair"}))
      ->capture_default_str();
  auto* speed = app.add_option("--speed", arguments.speed, "Play in time, this many times faster")
                    ->check(CLI::PositiveNumber);
  app.add_flag("--step", arguments.step, "Wait for Enter on standard input at each step; q ends")
      ->excludes(speed);
  app.add_flag("--json", arguments.json, "Print the summary as JSON");
  app.add_flag("--quiet", arguments.quiet, "Print errors only");
  app.add_flag("--verbose", arguments.verbose, "Print every step");
  return run_program(app, argc, argv, [&] { return play(arguments); },
                     {kCommandLine, kCommandLine});
}
