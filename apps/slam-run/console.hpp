#pragma once
// What slam-run shows while it works, remembered for log.txt.

#include <filesystem>
#include <sstream>
#include <string>

#include "../program/program.hpp"

namespace libslam {

/// Prints lines and remembers them for log.txt.
class Console {
 public:
  explicit Console(bool quiet) : quiet_(quiet), bar_(quiet) {}

  void say(const std::string& line);
  void warn(const std::string& line);
  void log(const std::string& line) { log_ << line << '\n'; }
  void progress(double fraction) { bar_.show(fraction); }
  void clear_progress() { bar_.clear(); }
  void save(const std::filesystem::path& file) const;

 private:
  bool quiet_;
  ProgressBar bar_;
  std::ostringstream log_;
};

}  // namespace libslam
