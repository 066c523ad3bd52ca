#include <filesystem>

#include <gtest/gtest.h>

#include <libslam/campaign/campaign_plan.hpp>
#include <libslam/config/validation.hpp>
#include <libslam/config/yaml_loader.hpp>
#include <libslam/pipeline/simulation.hpp>

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
    const std::string name = file.path().filename();
    if (name.starts_with("sim_")) {
      EXPECT_NO_THROW(validate(load_scenario(file.path(), &places), places));
      continue;
    }
    if (name.starts_with("mc_")) {
      EXPECT_NO_THROW(load_campaign(file.path()));
      continue;
    }
    EXPECT_NO_THROW(validate(load_yaml(file.path(), &places), places));
    EXPECT_FALSE(places.empty()) << "sets nothing";
    ++files;
  }
  EXPECT_GT(files, 0);
}

}  // namespace
}  // namespace libslam
