#pragma once
// What all programs have in common: exit codes, Ctrl-C, one line per failure, a progress bar.

#include <atomic>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

namespace libslam {

/// What the exit codes promise to scripts.
enum ExitCode {
  kDone = 0,
  kCommandLine = 2,
  kConfiguration = 3,
  kInput = 4,
  kIncomplete = 5,
  kInterrupted = 7
};

/// Becomes true when Ctrl-C or SIGTERM comes; the first call takes these signals over.
std::atomic<bool>& stop_on_signals();

/// "NAME VERSION (REVISION)".
std::string version_line(const std::string& program);

/// Exit codes of what is not an InputError.
struct FailureCodes {
  ExitCode configuration = kConfiguration;  ///< ConfigError and std::invalid_argument
  ExitCode other = kCommandLine;
};

/// Prints "PROGRAM: what went wrong" and returns the exit code for it.
ExitCode describe_failure(const std::string& program, const std::exception& error,
                          const FailureCodes& codes = {});

/// Parses the command line, then acts. Failures end in one line and their exit code.
int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& act,
                const FailureCodes& codes = {});

/// A bar on a terminal; nothing elsewhere.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `fraction` in 0 .. 1.
  void show(double fraction);
  void clear();

 private:
  bool shows_;
  int shown_ = -1;
};

}  // namespace libslam
