// Whatever a file holds, loading it ends with parameters or with one clear line, soon.

#include <algorithm>
#include <random>
#include <sys/stat.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <libslam/config/ini_loader.hpp>
#include <libslam/config/text_file.hpp>
#include <libslam/config/yaml_loader.hpp>

#include "support/config_error_message.hpp"
#include "support/temporary_directory.hpp"

namespace libslam {
namespace {

using test::config_error_message;
using test::TemporaryDirectory;

std::string random_bytes(std::size_t size, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::string bytes(size, '\0');
  std::ranges::generate(bytes, [&] { return static_cast<char>(random() & 0xFFU); });
  return bytes;
}

std::string repeat(std::string_view piece, std::size_t times) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) {
    text += piece;
  }
  return text;
}

/// Every loader, on one content: either it loads or it names the file in one printable line.
void load_both(const std::string& content) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory.write("file", content);
  for (const auto& load : {+[](const std::filesystem::path& path) { load_yaml(path); },
                           +[](const std::filesystem::path& path) { load_kf_slam_ini(path); }}) {
    try {
      load(file);
    } catch (const ConfigError& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with(file.string() + ":")) << message;
      EXPECT_LT(message.size(), 500U);
      EXPECT_TRUE(std::ranges::none_of(message, [](char c) {
        return static_cast<unsigned char>(c) < 0x20;
      })) << message;
    }
  }
}

TEST(MalformedFile, RandomBytes) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    load_both(random_bytes(seed * 97, seed));
  }
}

TEST(MalformedFile, BinaryGarbageOfAMegabyteIsNoYaml) {
  const TemporaryDirectory directory;
  const auto file = directory.write("file.yaml", random_bytes(kMaxConfigBytes, 7));
  EXPECT_NE(config_error_message([&] { load_yaml(file); }).find("not valid YAML"),
            std::string::npos);
}

TEST(MalformedFile, OneByteOfAGoodFileChanged) {
  const std::string good = to_yaml({});
  std::mt19937 random(11);
  for (int i = 0; i < 200; ++i) {
    std::string bad = good;
    bad[random() % bad.size()] = static_cast<char>(random() & 0xFFU);
    load_both(bad);
  }
}

TEST(MalformedFile, GoodFileCutAnywhere) {
  const std::string good = to_yaml({});
  for (std::size_t length = 0; length < good.size(); length += 83) {
    load_both(good.substr(0, length));
  }
}

TEST(MalformedFile, LargerThanAnyConfiguration) {
  const TemporaryDirectory directory;
  const auto file = directory.write("huge.yaml", repeat("# comment\n", kMaxConfigBytes / 10 + 1));
  for (const std::string& message : {config_error_message([&] { load_yaml(file); }),
                                     config_error_message([&] { load_kf_slam_ini(file); })}) {
    EXPECT_EQ(message,
              file.string() + ": larger than 1048576 bytes, this is not a configuration file");
  }
}

TEST(MalformedFile, EndlessDeviceStopsAtTheLimit) {
  EXPECT_NE(config_error_message([] { load_yaml("/dev/zero"); }).find("larger than"),
            std::string::npos);
}

TEST(MalformedFile, DeepNestingOfEveryKind) {
  constexpr std::size_t kDeep = 100'000;
  for (const char* piece : {"[", "{a: ", "- ", "? ", "[{a: "}) {
    const std::string message =
        config_error_message([&] { load_yaml_text(repeat(piece, kDeep), "deep.yaml"); });
    EXPECT_TRUE(message.starts_with("deep.yaml:1:")) << message;
  }
  EXPECT_NE(config_error_message([] {
              load_yaml_text("motion: " + repeat("[", kDeep) + repeat("]", kDeep), "deep.yaml");
            }).find("nested deeper than 8 levels"),
            std::string::npos);
}

TEST(MalformedFile, LongKeysAndValuesAreCutInMessages) {
  const std::string message = config_error_message(
      [] { load_yaml_text("motion:\n  " + std::string(900, 'k') + ": 1\n", "c"); });
  EXPECT_LT(message.size(), 200U);
  EXPECT_TRUE(config_error_message([] {
                load_yaml_text("motion:\n  model: " + repeat("é", 100'000) + "\n", "c");
              }).starts_with("c:2:10: motion.model: 'é"));
}

TEST(MalformedFile, ManyKeys) {
  std::string text = "motion:\n";
  while (text.size() < kMaxConfigBytes - 20) {
    text += "  k" + std::to_string(text.size()) + ": 1\n";
  }
  EXPECT_TRUE(config_error_message([&] {
                load_yaml_text(text, "c");
              }).starts_with("c:2:3: unknown key 'motion.k8'"));
}

TEST(MalformedFile, BytesThatAreNoUtf8) {
  EXPECT_TRUE(config_error_message([] {
                load_yaml_text("motion:\n  model: \"\xC3(\"\n", "c");
              }).starts_with("c:2:12: not valid YAML: "));
  EXPECT_TRUE(config_error_message([] {
                load_yaml_text(std::string("motion:\n  model: a\0b\n", 21), "c");
              }).starts_with("c:2:11: not valid YAML: "));
}

TEST(MalformedFile, WithoutPermissionOrContent) {
  const TemporaryDirectory directory;
  EXPECT_NO_THROW(load_yaml(directory.write("empty.yaml", "")));
  EXPECT_EQ(config_error_message([&] { load_kf_slam_ini(directory.path() / "absent.ini"); }),
            (directory.path() / "absent.ini").string() + ": no such file");
  if (geteuid() == 0) {
    return;  // root reads every file: there is nothing to refuse
  }
  const auto secret = directory.write("secret.yaml", "motion:\n");
  ASSERT_EQ(chmod(secret.c_str(), 0), 0);
  EXPECT_EQ(config_error_message([&] { load_yaml(secret); }),
            secret.string() + ": cannot be opened for reading");
}

}  // namespace
}  // namespace libslam
