#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include <libslam/config/digest.hpp>

#include "support/temporary_directory.hpp"

namespace libslam {
namespace {

// Test vectors of FIPS 180-4 as published by NIST.
TEST(Sha256, OfPublishedVectors) {
  EXPECT_EQ(sha256_of_text(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of_text("abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_text(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, OfAFileIsThatOfItsBytes) {
  const test::TemporaryDirectory directory;
  // Longer than one piece, no multiple of it, with bytes that text mode would change.
  std::string content;
  for (int i = 0; i < 200'003; ++i) {
    content += static_cast<char>(i % 256);
  }
  EXPECT_EQ(sha256_of_file(directory.write("data", content)), sha256_of_text(content));
  EXPECT_EQ(sha256_of_file(directory.write("empty", "")), sha256_of_text(""));
}

TEST(Sha256, OfAMissingFileOrADirectoryThrows) {
  const test::TemporaryDirectory directory;
  EXPECT_THROW(sha256_of_file(directory.path() / "absent"), std::runtime_error);
  EXPECT_THROW(sha256_of_file(directory.path()), std::runtime_error);
}

}  // namespace
}  // namespace libslam
