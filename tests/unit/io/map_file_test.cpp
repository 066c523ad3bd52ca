// Saved maps in files: the same bits back, and no file that is believed without a check.

#include <cmath>
#include <cstring>
#include <random>
#include <sstream>
#include <tests/support/random_matrix.hpp>
#include <tests/support/temporary_directory.hpp>

#include <gtest/gtest.h>

#include <libslam/config/digest.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/map_encoding.hpp>
#include <libslam/io/map_file.hpp>
#include <libslam/map/landmark_map.hpp>

using namespace libslam;
using libslam::test::TemporaryDirectory;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

namespace {

constexpr std::size_t kVersion = 8, kDimension = 12, kPose = 16, kParameters = 20, kMemory = 24,
                      kLandmarks = 28, kRows = 40, kDigest = 64;

SavedMap full_map(int dimension) {
  std::mt19937_64 random(92);
  SavedMap map;
  map.dimension = dimension;
  map.pose = dimension == 2 ? BlockVector(Eigen::Vector3d(1, 2, 0.3)) : BlockVector::Unit(7, 4);
  map.calibration = {{"scale_left", 1.0 / 3.0}, {"scale_right", 0.98}};
  map.excitation = {1.5, -2.25, 1e-300};
  map.next_number = 4711;
  for (int i = 0; i < 5; ++i) {
    SavedLandmark& landmark = map.landmarks.emplace_back();
    landmark.id = (std::int64_t{1} << 33) + i;
    landmark.mean = random_matrix(dimension, 1, random);
    landmark.times_seen = 3 * i;
    landmark.updates = 100 - i;
    landmark.confirmed = i != 2;
    landmark.exact = i == 3;
  }
  Descriptor descriptor;
  descriptor.kind = Descriptor::Kind::kNumbers;
  descriptor.size = 128;
  for (std::size_t i = 0; i < 128; ++i) descriptor.bytes[i] = static_cast<std::uint8_t>(255 - i);
  map.landmarks[4].appearance = std::make_shared<Descriptor>(descriptor);
  map.cov = random_covariance(static_cast<int>(map.tangent()), random);
  map.cov = 0.5 * (map.cov + map.cov.transpose()).eval();
  return map;
}

/// Five lines, one without an extent, one that the building prior has judged.
SavedMap line_map() {
  SavedMap map = full_map(2);
  for (SavedLandmark& line : map.landmarks) {
    line.type = "line";
    line.appearance = nullptr;
    line.extent = Extent{-1.0 / 3.0 - static_cast<double>(line.times_seen), 2.5, 0.01, 1e-300};
  }
  map.landmarks[1].extent.reset();
  map.landmarks[2].prior_judged = true;
  return map;
}

/// The digest made to fit again, so that what stands before it is believed.
std::string sealed(std::string bytes) {
  bytes.resize(bytes.size() - kDigest);
  return bytes + sha256_of_text(bytes);
}

template <typename Number>
std::string patched(std::string bytes, std::size_t at, Number value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
  return sealed(bytes);
}

std::string message_of(const std::string& bytes) {
  try {
    decode_map(bytes, "the.slammap");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(MapFile, EverythingComesBackBitForBit) {
  for (const int dimension : {2, 3}) {
    const SavedMap map = full_map(dimension);
    const std::string bytes = encode_map(map);
    const SavedMap back = decode_map(bytes, "");
    EXPECT_EQ(back.dimension, dimension);
    EXPECT_EQ(back.pose, map.pose);
    EXPECT_EQ(back.calibration[0].name, "scale_left");
    EXPECT_EQ(back.calibration[0].mean, 1.0 / 3.0);
    EXPECT_EQ(back.excitation, map.excitation);
    EXPECT_EQ(back.next_number, 4711);
    EXPECT_EQ(back.cov, map.cov);
    ASSERT_EQ(back.landmarks.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(back.landmarks[i].id, map.landmarks[i].id);
      EXPECT_EQ(back.landmarks[i].mean, map.landmarks[i].mean);
      EXPECT_EQ(back.landmarks[i].times_seen, map.landmarks[i].times_seen);
      EXPECT_EQ(back.landmarks[i].updates, map.landmarks[i].updates);
      EXPECT_EQ(back.landmarks[i].confirmed, map.landmarks[i].confirmed);
      EXPECT_EQ(back.landmarks[i].exact, map.landmarks[i].exact);
    }
    EXPECT_EQ(back.landmarks[0].appearance, nullptr);
    EXPECT_EQ(back.landmarks[4].appearance->bytes, map.landmarks[4].appearance->bytes);
    EXPECT_EQ(back.landmarks[4].appearance->kind, Descriptor::Kind::kNumbers);
    EXPECT_EQ(encode_map(back), bytes);
  }
}

TEST(MapFile, NoTruncationAndNoFlippedByteIsBelieved) {
  const std::string bytes = encode_map(full_map(2));
  for (std::size_t length = 0; length < bytes.size(); ++length)
    ASSERT_NE(message_of(bytes.substr(0, length)), "") << length;
  ASSERT_NE(message_of(bytes + '\0'), "");
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string flipped = bytes;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x40);
    ASSERT_NE(message_of(flipped), "") << at;
  }
}

// Whoever writes a wrong map can also write its digest: counts and values are checked on their own.
TEST(MapFile, AnyByteMayChangeWithAFittingDigest) {
  const std::string bytes = encode_map(full_map(3));
  std::mt19937_64 random(93);
  for (std::size_t at = 0; at + kDigest < bytes.size(); ++at)
    for (const int value : {0, 1, 0x7f, 0xff, static_cast<int>(random() % 256)})
      EXPECT_NO_THROW(message_of(patched(bytes, at, static_cast<std::uint8_t>(value)))) << at;
}

TEST(MapFile, AbsurdCountsAreNamedBeforeAnythingIsAllocated) {
  const std::string bytes = encode_map(full_map(2));
  EXPECT_NE(message_of(patched(bytes, 0, 'X')).find("no saved map"), std::string::npos);
  EXPECT_NE(message_of(patched(bytes, kVersion, 2u)).find("version 2"), std::string::npos);
  EXPECT_NE(message_of(patched(bytes, kDimension, 7u)).find("7 coordinates"), std::string::npos);
  EXPECT_NE(message_of(patched(bytes, kPose, 6u)).find("pose of 6"), std::string::npos);
  constexpr std::uint32_t kMany = 0xffffffff;
  for (const std::size_t at : {kParameters, kMemory, kLandmarks})
    EXPECT_NE(message_of(patched(bytes, at, kMany)).find("too short"), std::string::npos) << at;
  for (const std::uint64_t rows : {std::uint64_t{20000}, std::uint64_t{20001}, ~std::uint64_t{0}})
    EXPECT_NE(message_of(patched(bytes, kRows, rows)), "") << rows;
}

TEST(MapFile, ValuesThatCannotBeAreNamed) {
  const std::string bytes = encode_map(full_map(2));
  const std::size_t last = bytes.size() - kDigest - sizeof(double);  // the last variance
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message_of(patched(bytes, last, nan)).find("not finite"), std::string::npos);
  EXPECT_NE(message_of(patched(bytes, last, -1.0)).find("negative"), std::string::npos);
  EXPECT_NE(message_of(patched(bytes, last - 8, 1e9)).find("semi-definite"), std::string::npos);
}

TEST(MapFile, WritesACsvOfTheConfirmedLandmarksBeside) {
  const TemporaryDirectory scratch;
  const SavedMap map = full_map(2);
  const auto file = scratch.path() / "hall.slammap";
  write_map_file(file, map);
  EXPECT_EQ(encode_map(read_map_file(file, 0.0)), encode_map(map));
  const LandmarkMap readable = read_landmark_map(scratch.path() / "hall.csv");
  ASSERT_EQ(readable.size(), 4u);
  const LandmarkEstimate& last = *readable.find(map.landmarks[4].id);
  EXPECT_EQ(last.mean, map.landmarks[4].mean);
  EXPECT_EQ(last.cov, map.cov.bottomRightCorner(2, 2));
  EXPECT_EQ(readable.find(map.landmarks[3].id)->cov, Eigen::MatrixXd::Zero(2, 2));
  EXPECT_THROW(read_map_file(scratch.path() / "hall.csv", 0.0), InputError);
  EXPECT_THROW(read_map_file(scratch.path() / "none.slammap", 0.0), InputError);
  EXPECT_THROW(write_map_file(scratch.path() / "hall.csv", map), std::invalid_argument);
  EXPECT_THROW(write_map_file(scratch.path() / "no/hall.slammap", map), std::runtime_error);
}

TEST(MapFile, ReadsSurveyedLandmarks) {
  const TemporaryDirectory scratch;
  const auto file = scratch.write("x.landmarks.csv", "id,x,y\n4,1.5,2\n9,-3,0.25\n");
  const SavedMap map = read_map_file(file, 0.1);
  EXPECT_EQ(map.landmarks[1].id, 9);
  EXPECT_EQ(map.landmarks[1].mean, Eigen::VectorXd(Eigen::Vector2d(-3, 0.25)));
  EXPECT_DOUBLE_EQ(map.cov(3, 3), 0.01);
  EXPECT_EQ(map.pose.size(), 0);
  EXPECT_THROW(read_map_file(scratch.write("mixed.csv", "1,2,3\n2,3,4,5\n"), 0.0), InputError);
  EXPECT_THROW(read_map_file(scratch.write("twice.csv", "1,2,3\n1,3,4\n"), 0.0), InputError);
}

TEST(MapFile, LinesKeepTheirExtents) {
  const SavedMap map = line_map();
  const std::string bytes = encode_map(map);
  const SavedMap back = decode_map(bytes, "the.slammap");
  EXPECT_EQ(encode_map(back), bytes);
  ASSERT_EQ(back.landmarks.size(), map.landmarks.size());
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const SavedLandmark &a = map.landmarks[i], &b = back.landmarks[i];
    EXPECT_EQ(b.type, "line");
    EXPECT_EQ(b.prior_judged, a.prior_judged);
    ASSERT_EQ(b.extent.has_value(), a.extent.has_value());
    if (!a.extent) continue;
    EXPECT_EQ(b.extent->begin, a.extent->begin);
    EXPECT_EQ(b.extent->end, a.extent->end);
    EXPECT_EQ(b.extent->sigma_begin, a.extent->sigma_begin);
    EXPECT_EQ(b.extent->sigma_end, a.extent->sigma_end);
  }
}

TEST(MapFile, RefusesExtentsThatCannotBe) {
  for (const Extent& wrong : {Extent{1.0, 0.0, 0.1, 0.1}, Extent{0.0, 1.0, -0.1, 0.1},
                              Extent{0.0, std::nan(""), 0.1, 0.1}}) {
    SavedMap map = line_map();
    map.landmarks[0].extent = wrong;
    EXPECT_THROW(encode_map(map), std::invalid_argument);
  }
}
