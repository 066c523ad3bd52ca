#include "console.hpp"

#include <fstream>
#include <iostream>

namespace libslam {

void Console::say(const std::string& line) {
  log(line);
  if (!quiet_) std::cout << line << '\n';
}

void Console::warn(const std::string& line) {
  log(line);
  clear_progress();
  std::cerr << line << '\n';
}

void Console::save(const std::filesystem::path& file) const {
  std::ofstream(file) << log_.str();
}

}  // namespace libslam
