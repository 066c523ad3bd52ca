#include <filesystem>

#include <gtest/gtest.h>

#include <libslam/config/validation.hpp>
#include <libslam/config/yaml_loader.hpp>

namespace libslam {
namespace {

TEST(ShippedConfigurations, LoadAndAreSound) {
  int files = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(std::filesystem::path(LIBSLAM_SOURCE_DIR) / "config")) {
    if (file.path().extension() != ".yaml") {
      continue;
    }
    SCOPED_TRACE(file.path().string());
    ParameterPlaces places;
    EXPECT_NO_THROW(validate(load_yaml(file.path(), &places), places));
    EXPECT_FALSE(places.empty()) << "sets nothing";
    ++files;
  }
  EXPECT_GT(files, 0);
}

}  // namespace
}  // namespace libslam
