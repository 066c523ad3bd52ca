#include <filesystem>
#include <support/temporary_directory.hpp>

#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservationStereoImages.h>

#include <libslam/io/importers/kitti_images.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/truth_reader.hpp>

#include "log_builder.hpp"

namespace libslam::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRow = "700 0 60 0 0 710 20 0 0 0 1 0\n";
constexpr const char* kRightRow = "700 0 60 -350 0 710 20 0 0 0 1 0\n";

class KittiImages : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* side : {"image_l", "image_r"}) {
      fs::create_directories(data() / side);
      for (int k = 0; k < 3; ++k) save(side, k, 120);
    }
    write("calib.txt", std::string(kRow) + kRightRow);
    // One metre ahead, then a quarter turn to the right (about Y, down) on the spot.
    write("poses.txt",
          "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n0 0 1 0 0 1 0 0 -1 0 0 1\n");
  }
  fs::path data() const { return directory_.path() / "data"; }
  std::string rawlog() const { return (directory_.path() / "x.rawlog").string(); }
  void write(const char* name, const std::string& text) const {
    std::ofstream(data() / name) << text;
  }
  void save(const char* side, int number, int width) const {
    mrpt::img::CImage image(static_cast<unsigned>(width), 40, mrpt::img::CH_GRAY);
    image.filledRectangle(0, 0, width - 1, 39, mrpt::img::TColor::gray());
    *image.ptr<std::uint8_t>(3, 2) = static_cast<std::uint8_t>(10 + number);
    ASSERT_TRUE(
        image.saveToFile((data() / side / ("00000" + std::to_string(number) + ".png")).string()));
  }
  std::string rejection() const {
    try {
      import_kitti_images(data().string(), rawlog());
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  TemporaryDirectory directory_;
};

TEST_F(KittiImages, RawlogHoldsPairsWithImagesBesideIt) {
  const auto summary = import_kitti_images(data().string(), rawlog());
  EXPECT_EQ(summary.pairs, 3);
  EXPECT_EQ(summary.true_poses, 3);
  RawlogPlayer player(rawlog(), with_policy("strict"));
  const auto steps = play(player);
  ASSERT_EQ(steps.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto pair = steps[k].frame->getObservationByClass<mrpt::obs::CObservationStereoImages>();
    ASSERT_TRUE(pair);
    EXPECT_TRUE(pair->imageLeft.isExternallyStored());
    EXPECT_EQ(pair->imageLeft.getWidth(), 120U);
    EXPECT_EQ(*pair->imageRight.ptr<std::uint8_t>(3, 2), 10 + k);
    EXPECT_DOUBLE_EQ(pair->leftCamera.fx(), 700.0);
    EXPECT_DOUBLE_EQ(pair->leftCamera.fy(), 710.0);
    EXPECT_EQ(pair->leftCamera.ncols, 120U);
    EXPECT_NEAR(pair->rightCameraPose.x(), 0.5, 1e-12);
    EXPECT_TRUE(pair->areImagesRectified());
    // Z of the camera is x of the robot, X is -y, Y is -z.
    mrpt::math::TPoint3D p;
    mrpt::poses::CPose3D(pair->cameraPose).composePoint({1.0, 2.0, 3.0}, p);
    EXPECT_NEAR(p.x, 3.0, 1e-12);
    EXPECT_NEAR(p.y, -1.0, 1e-12);
    EXPECT_NEAR(p.z, -2.0, 1e-12);
  }
  EXPECT_NEAR(steps[2].time - steps[0].time, 0.2, 1e-6);
}

TEST_F(KittiImages, TruthIsThePoseOfTheRobot) {
  import_kitti_images(data().string(), rawlog());
  const Trajectory path = read_truth(find_truth(rawlog())).path;
  ASSERT_EQ(path.poses.size(), 3U);
  EXPECT_TRUE(path.poses[1].isApprox(Eigen::Vector3d(1.0, 0.0, 0.0), 1e-9));
  EXPECT_TRUE(path.poses[2].isApprox(Eigen::Vector3d(1.0, 0.0, -M_PI / 2), 1e-6))
      << path.poses[2].transpose();
}

TEST_F(KittiImages, BenchmarkLayoutAndTimes) {
  fs::rename(data() / "image_l", data() / "image_0");
  fs::rename(data() / "image_r", data() / "image_1");
  write("calib.txt", std::string("P0: ") + kRow + "P1: " + kRightRow + "Tr: " + kRow);
  write("times.txt", "0\n0.104\n0.21\n");
  const auto summary = import_kitti_images(data().string(), rawlog());
  EXPECT_NEAR(summary.baseline, 0.5, 1e-12);
  RawlogPlayer player(rawlog(), with_policy("strict"));
  const auto steps = play(player);
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_NEAR(steps[1].time - steps[0].time, 0.104, 1e-6);
}

TEST_F(KittiImages, RejectsWhatIsNoStereoData) {
  write("calib.txt", kRow);
  EXPECT_NE(rejection().find("two projection matrices"), std::string::npos) << rejection();
  write("calib.txt", std::string(kRightRow) + kRow);
  EXPECT_NE(rejection().find("right camera at the right"), std::string::npos) << rejection();
  write("calib.txt", std::string(kRow) + kRightRow);
  std::ofstream(data() / "image_r" / "000001.png") << "no image";
  testing::internal::CaptureStderr();
  EXPECT_NE(rejection().find("000001.png: is no image"), std::string::npos) << rejection();
  fs::remove(data() / "image_r" / "000001.png");
  EXPECT_NE(rejection().find("image"), std::string::npos) << rejection();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  fs::remove_all(data() / "image_r");
  EXPECT_NE(rejection().find("no folders"), std::string::npos) << rejection();
}

TEST_F(KittiImages, AMissingImageIsNotTheEndAndLeavesNoLog) {
  fs::remove(data() / "image_l" / "000001.png");
  EXPECT_NE(rejection().find("000001.png: no such file"), std::string::npos) << rejection();
  EXPECT_FALSE(fs::exists(rawlog()));
  save("image_l", 1, 120);
  fs::resize_file(data() / "image_l" / "000002.png", 20);
  EXPECT_NE(rejection().find("000002.png"), std::string::npos) << rejection();
  EXPECT_FALSE(fs::exists(rawlog()));
}

TEST_F(KittiImages, StopsWhenAskedTo) {
  int asked = 0;
  const auto summary = import_kitti_images(data().string(), rawlog(), [&] { return ++asked > 2; });
  EXPECT_FALSE(summary.complete);
  EXPECT_EQ(summary.pairs, 2);
  RawlogPlayer player(rawlog(), with_policy("strict"));
  EXPECT_EQ(play(player).size(), 2U);
}

}  // namespace
}  // namespace libslam::test
