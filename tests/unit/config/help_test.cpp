#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <gtest/gtest.h>

#include <libslam/config/help.hpp>
#include <libslam/config/parameter_table.hpp>

namespace libslam {
namespace {

TEST(Help, NamesEveryParameterWithDefaultAndMeaning) {
  const std::string text = help_text();
  for (const ParameterEntry& entry : list_parameters({})) {
    const std::string value = entry.value.empty() ? "\"\"" : entry.value;
    EXPECT_NE(text.find(entry.name + " = " + value + "\n"), std::string::npos) << entry.name;
  }
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 100U) << line;
  }
}

TEST(Help, ConfigReadmeIsInStep) {
  const std::filesystem::path readme =
      std::filesystem::path(LIBSLAM_SOURCE_DIR) / "config/README.md";
  std::ifstream file(readme, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(content, help_markdown())
      << "regenerate with: slam-run --help-config markdown > config/README.md";
}

}  // namespace
}  // namespace libslam
