#include "program.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <unistd.h>

#include <libslam/config/config_error.hpp>
#include <libslam/config/version.hpp>
#include <libslam/io/input_error.hpp>

namespace libslam {

namespace {

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");

}  // namespace

std::atomic<bool>& stop_on_signals() {
  std::signal(SIGINT, [](int) { g_stop = true; });
  std::signal(SIGTERM, [](int) { g_stop = true; });
  return g_stop;
}

std::string version_line(const std::string& program) {
  return program + " " + std::string(version()) + " (" + std::string(git_revision()) + ")";
}

ExitCode describe_failure(const std::string& program, const std::exception& error,
                          const FailureCodes& codes) {
  std::cerr << program << ": " << error.what() << std::endl;
  if (dynamic_cast<const InputError*>(&error) != nullptr) return kInput;
  const bool configuration = dynamic_cast<const ConfigError*>(&error) != nullptr ||
                             dynamic_cast<const std::invalid_argument*>(&error) != nullptr;
  return configuration ? codes.configuration : codes.other;
}

int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& act,
                const FailureCodes& codes) {
  try {
    app.parse(argc, argv);
    return act();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kCommandLine;
  } catch (const std::exception& error) {
    return describe_failure(app.get_name(), error, codes);
  }
}

ProgressBar::ProgressBar(bool quiet) : shows_(!quiet && isatty(STDERR_FILENO) != 0) {}

void ProgressBar::show(double fraction) {
  const int percent = static_cast<int>(100.0 * std::clamp(fraction, 0.0, 1.0));
  if (!shows_ || percent == shown_) return;
  shown_ = percent;
  std::fprintf(stderr, "\r[%-40s] %3d %%",
               std::string(static_cast<std::size_t>(percent * 2 / 5), '#').c_str(), percent);
}

void ProgressBar::clear() {
  if (shown_ >= 0) std::fputs("\r\033[K", stderr);
  shown_ = -1;
}

}  // namespace libslam
