#include <algorithm>

#include <gtest/gtest.h>

#include <libslam/config/version.hpp>

namespace libslam {
namespace {

TEST(Version, IsThatOfTheProject) {
  EXPECT_EQ(version(), LIBSLAM_EXPECTED_VERSION);
}

TEST(Version, RevisionIsAShortHashOrUnknown) {
  const std::string_view revision = git_revision();
  const bool is_hash = revision.size() >= 4 && std::ranges::all_of(revision, [](char c) {
                         return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
                       });
  EXPECT_TRUE(is_hash || revision == "unknown") << revision;
}

}  // namespace
}  // namespace libslam
