// PNG files, whole and damaged; nothing is written to the standard error.

#include <filesystem>
#include <fstream>
#include <support/temporary_directory.hpp>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <libslam/frontend/png_image.hpp>

#include "stereo_fixture.hpp"

namespace libslam {
namespace {

using namespace libslam::testing;

class PngImage : public ::testing::Test {
 protected:
  std::string file() const { return (directory_.path() / "left.png").string(); }
  void save(const cv::Mat& pixels) const { ASSERT_TRUE(cv::imwrite(file(), pixels)); }
  void expect_as_opencv(int flags) const {
    const cv::Mat expected = cv::imread(file(), flags), pixels = read_png(file());
    ASSERT_EQ(pixels.size(), expected.size());
    ASSERT_EQ(pixels.type(), expected.type());
    EXPECT_EQ(cv::norm(pixels, expected, cv::NORM_INF), 0.0);
  }
  /// Changes the bytes of the file; returns the defect.
  std::string defect(const std::function<void(std::string&)>& spoil) const {
    const Texture texture(2);
    cv::Mat pixels(80, 100, CV_8U);
    for (int y = 0; y < pixels.rows; ++y)
      for (int x = 0; x < pixels.cols; ++x)
        pixels.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(texture(x, y));
    save(pixels);
    std::ifstream in(file(), std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(in)), {});
    spoil(bytes);
    std::ofstream(file(), std::ios::binary) << bytes;
    try {
      read_png(file());
    } catch (const DamagedPng& damaged) {
      return damaged.what();
    }
    return "read";
  }

  test::TemporaryDirectory directory_;
};

TEST_F(PngImage, HasThePixelsOfTheFile) {
  cv::Mat pixels(70, 90, CV_8UC4);
  for (int y = 0; y < pixels.rows; ++y)
    for (int x = 0; x < pixels.cols; ++x)
      for (int c = 0; c < 4; ++c)
        pixels.at<cv::Vec4b>(y, x)[c] = static_cast<std::uint8_t>(20 + x + c * y % 90);
  save(pixels);
  expect_as_opencv(cv::IMREAD_COLOR);  // without transparency
  cv::Mat channel;
  cv::extractChannel(pixels, channel, 2);
  save(channel);
  expect_as_opencv(cv::IMREAD_UNCHANGED);
}

TEST_F(PngImage, SaysWhatIsWrongToTheCallerAlone) {
  ::testing::internal::CaptureStderr();
  const auto expect = [&](const char* words, const std::function<void(std::string&)>& spoil) {
    const std::string said = defect(spoil);
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  };
  expect("read", [](std::string&) {});
  expect("PNG: ", [](std::string& bytes) { bytes.clear(); });
  expect("PNG: ", [](std::string& bytes) { bytes = "no image"; });
  expect("PNG: ", [](std::string& bytes) { bytes.resize(bytes.size() / 2); });
  expect("PNG: IDAT", [](std::string& bytes) { bytes[bytes.size() / 2] ^= 1; });
  EXPECT_EQ(defect([](std::string&) {}), "read");
  EXPECT_THROW(read_png(file(), 99), DamagedPng);  // 100 wide
  std::filesystem::remove(file());
  EXPECT_THROW(read_png(file()), DamagedPng);
  std::filesystem::create_directory(file());
  EXPECT_THROW(read_png(file()), DamagedPng);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(PngImage, DamagedImagesOfALogAreOneWarning) {
  EXPECT_EQ(defect([](std::string& bytes) { bytes.resize(300); }).find("PNG: "), 0U);
  const auto pair = wall_at(20.0);
  pair->imageLeft.setExternalStorage(file());
  StereoFeatures frontend(stereo_parameters(), "", true);
  ::testing::internal::CaptureStderr();
  EXPECT_TRUE(features_of(frontend, pair).empty());
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  ASSERT_EQ(frontend.warnings().size(), 1U);
  EXPECT_NE(frontend.warnings().front().find("left.png: cannot be read: PNG: "), std::string::npos);
}

TEST_F(PngImage, AFolderThatIsNotThereIsOneWarning) {
  const auto pair = wall_at(20.0);
  StereoFeatures frontend(stereo_parameters(), "", true);
  for (const char* name : {"/000.png", "/001.png", "/002.png"}) {
    pair->imageLeft.setExternalStorage(file() + "_Images" + name);
    EXPECT_TRUE(features_of(frontend, pair).empty());
  }
  EXPECT_EQ(frontend.unusable(), 3);
  ASSERT_EQ(frontend.warnings().size(), 1U);
  EXPECT_NE(frontend.warnings().front().find("folder of the images is missing: " + file()),
            std::string::npos)
      << frontend.warnings().front();
}

}  // namespace
}  // namespace libslam
