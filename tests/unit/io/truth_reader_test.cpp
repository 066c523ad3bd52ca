#include <cmath>
#include <support/temporary_directory.hpp>

#include <gtest/gtest.h>

#include <libslam/io/input_error.hpp>
#include <libslam/io/text_reader.hpp>
#include <libslam/io/truth_reader.hpp>

namespace libslam {
namespace {

const std::string kPackaged = "/usr/share/mrpt/datasets/";

class TruthReader : public testing::Test {
 protected:
  std::string file(const std::string& text) { return directory_.write("t.txt", text).string(); }

  /// Message of the InputError that `read` throws on a file with this text.
  template <typename Read>
  std::string error_of(Read read, const std::string& text) {
    try {
      read(file(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  test::TemporaryDirectory directory_;
};

TEST_F(TruthReader, TumTakesThePlanarPartOfThePose) {
  const Trajectory path = read_true_path(
      file("# comment\n1.5 1 2 9 0 0 0.7071067811865476 0.7071067811865476\n2.5,3,4,9,0,0,0,2\n"));
  ASSERT_EQ(path.poses.size(), 2U);
  EXPECT_EQ(path.times[1], 2.5);
  EXPECT_NEAR(path.poses[0].z(), M_PI / 2, 1e-15);
  EXPECT_EQ(path.poses[1], Eigen::Vector3d(3, 4, 0));
}

TEST_F(TruthReader, APathThatLeavesThePlaneKeepsItsFullPoses) {
  const Trajectory tum = read_true_path(file("1 1 2 0 0 0 0 1\n2 3 4 -5 0.5 -0.5 0.5 0.5\n"));
  ASSERT_EQ(tum.spatial.size(), 2U);
  EXPECT_EQ(tum.spatial[1].position, Eigen::Vector3d(3, 4, -5));
  EXPECT_EQ(tum.spatial[1].rotation.coeffs(), Eigen::Vector4d(0.5, -0.5, 0.5, 0.5));
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LT((shadow_of(tum.spatial[i]) - tum.poses[i]).norm(), 1e-12);
  const Trajectory rolled = read_true_path(file("1 2 0 0.3 0 0\n1 2 0 0.3 0.2 0.1\n"));
  ASSERT_EQ(rolled.spatial.size(), 2U);
  // Yaw, pitch, roll as in mrpt::poses::CPose3D: the x axis of the robot seen from the world.
  EXPECT_LT((rolled.spatial[1].rotation * Eigen::Vector3d::UnitX() -
             Eigen::Vector3d(std::cos(0.3) * std::cos(0.2), std::sin(0.3) * std::cos(0.2),
                             -std::sin(0.2)))
                .norm(),
            1e-15);
  EXPECT_TRUE(read_true_path(file("1 1 2 0 0 0 0.6 0.8\n")).spatial.empty());
  EXPECT_TRUE(read_true_path(file("1 2 0 0.3 0 0\n")).spatial.empty());
}

TEST_F(TruthReader, PackagedTruthOfTheStockLogs) {
  const Trajectory flat = read_true_path(kPackaged + "kf-slam_demo_ground_truth_robot_path.txt");
  EXPECT_EQ(flat.poses.size(), 250U);
  EXPECT_TRUE(flat.times.empty());
  const auto landmarks = read_true_landmarks(kPackaged + "kf-slam_demo_ground_truth.txt");
  ASSERT_EQ(landmarks.size(), 70U);
  EXPECT_EQ(landmarks[0].id, 1);
  EXPECT_EQ(landmarks[0].position, Eigen::Vector3d(0.578229, 7.694330, 0.0));
  const TruthFiles files = find_truth(kPackaged + "kf-slam_demo.rawlog");
  EXPECT_EQ(read_truth(files).path.poses.size(), 250U);
  EXPECT_TRUE(files.notes.empty());
}

TEST_F(TruthReader, FilesBesideTheRawlogComeFirst) {
  const auto rawlog = directory_.write("a.rawlog", "x").string();
  EXPECT_TRUE(read_truth(find_truth(rawlog)).empty());
  directory_.write("a.truth.tum", "1 2 3 0 0 0 1 1\n");
  directory_.write("a.landmarks.csv", "id,x,y\n4,1.5,-2\n");
  directory_.write("a.truth.json",
                   R"({"has_heading": false, "calibration": {"scale_left": 0.96}})");
  const GroundTruth truth = read_truth(find_truth(rawlog));
  EXPECT_FALSE(truth.path.has_heading);
  EXPECT_EQ(truth.path.poses.at(0), Eigen::Vector3d(2, 3, 0));
  EXPECT_EQ(truth.landmarks.at(0).id, 4);
  EXPECT_EQ(truth.landmarks.at(0).position, Eigen::Vector2d(1.5, -2));
  EXPECT_EQ(truth.calibration.at("scale_left"), 0.96);
}

TEST_F(TruthReader, ErrorsNameFileAndLine) {
  const auto name = (directory_.path() / "t.txt").string();
  EXPECT_EQ(error_of(read_true_path, "1 0 0 0 0 0 0 1\n\n0.5 0 0 0 0 0 0 1\n"),
            name + ":3: time goes backwards");
  EXPECT_EQ(error_of(read_true_path, "1 0 0 0 0 0 0 0\n"), name + ":1: the quaternion is zero");
  EXPECT_EQ(error_of(read_true_path, "1 0 0 0 0 0 nan 1\n").substr(0, name.size() + 3),
            name + ":1:");
  EXPECT_EQ(error_of(read_true_path, "1 2 3\n").substr(0, name.size() + 3), name + ":1:");
  EXPECT_EQ(error_of(read_true_path, "# nothing\n"), name + ": holds no poses");
  EXPECT_EQ(error_of(read_true_landmarks, "1,0,0\n1,2,2\n"), name + ":2: landmark 1 comes twice");
  EXPECT_EQ(error_of(read_true_landmarks, "1,x,0\n").substr(0, name.size() + 3), name + ":1:");
  EXPECT_NE(error_of(read_truth_notes, "{\"has_heading\": 3}"), "accepted");
  EXPECT_NE(error_of(read_truth_notes, "[1,"), "accepted");
  EXPECT_THROW(read_true_path(directory_.path().string()), InputError);
  EXPECT_THROW(read_true_path("/no/such/file"), InputError);
}

TEST_F(TruthReader, TextRowsOfAnyLengthUpToTheLimit) {
  std::string text(70000, '1');
  EXPECT_EQ(error_of(read_true_path, text).find("t.txt:1: line longer than") == std::string::npos,
            false);
  // Rows that cross the block of 64 KiB in which the file is read.
  text.clear();
  for (int i = 0; i < 5000; ++i) text += std::to_string(i) + " 0 0 0 0 0 0 1\r\n";
  EXPECT_EQ(read_true_path(file(text)).times.back(), 4999.0);
  TextReader last(file("a b\nlast, 7 ,row"));
  EXPECT_TRUE(last.next() && last.next());
  EXPECT_EQ(last.columns(), 3U);
  EXPECT_EQ(last.integer(1), 7);
  EXPECT_FALSE(last.next());
}

}  // namespace
}  // namespace libslam
