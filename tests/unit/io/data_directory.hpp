#pragma once
// Where the public data sets are.

#include <cstdlib>
#include <filesystem>
#include <string>

namespace libslam::test {

/// `name` under $LIBSLAM_DATA, or under ../shared/data beside the checkout; empty if it is not
/// there.
inline std::string data_set(const std::string& name) {
  const char* configured = std::getenv("LIBSLAM_DATA");
  const std::filesystem::path root =
      configured != nullptr
          ? std::filesystem::path(configured)
          : std::filesystem::path(__FILE__).parent_path() / "../../../../shared/data";
  return std::filesystem::is_directory(root / name) ? (root / name).string() : std::string();
}

}  // namespace libslam::test
