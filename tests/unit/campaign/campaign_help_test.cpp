#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include <libslam/campaign/campaign_help.hpp>

namespace libslam {
namespace {

TEST(CampaignHelp, NamesKeysAsSettingsDo) {
  const std::string text = campaign_help_text();
  EXPECT_NE(text.find("\ncampaign.batches = 1\n"), std::string::npos);
  EXPECT_NE(text.find("\nscenario.truth.scale_left = 1\n"), std::string::npos);
}

TEST(CampaignHelp, ShippedPageIsInStep) {
  std::ifstream file(std::filesystem::path(LIBSLAM_SOURCE_DIR) / "config/CAMPAIGNS.md",
                     std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(content, campaign_help_markdown())
      << "regenerate with: slam-campaign --help-config markdown > config/CAMPAIGNS.md";
}

}  // namespace
}  // namespace libslam
