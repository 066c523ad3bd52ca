// Stereo measurements of GTSAM's visual-odometry example (features of a KITTI drive): 26 cameras,
// and with every measurement its point, triangulated by others.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <tests/unit/io/data_directory.hpp>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>

#include <libslam/measurement/stereo_point.hpp>

using namespace libslam;

namespace {

struct Sighting {
  int camera = 0, landmark = 0;
  Eigen::Vector3d z, p_camera;
};

/// Half a unit of the sixth digit.
double rounding(double value) {
  return 0.5 * std::pow(10.0, std::floor(std::log10(std::abs(value))) - 5.0);
}

class GtsamStereo : public testing::Test {
 protected:
  void SetUp() override {
    const std::string data = test::data_set("gtsam_stereo_vo");
    if (data.empty()) GTEST_SKIP() << "data set gtsam_stereo_vo is not in $LIBSLAM_DATA";
    auto camera = std::make_shared<StereoCamera>();
    double skew = 0.0;
    std::ifstream(data + "/VO_calibration.txt") >> camera->fx >> camera->fy >> skew >> camera->cx >>
        camera->cy >> camera->baseline;
    camera_ = camera;
    std::ifstream poses(data + "/VO_camera_poses_large.txt");
    for (int id = 0; poses >> id;) {
      Eigen::Matrix4d T;
      for (Eigen::Index i = 0; i < 16; ++i) poses >> T(i / 4, i % 4);
      BlockVector pose(7);
      pose << T.topRightCorner<3, 1>(),
          Eigen::Quaterniond(T.topLeftCorner<3, 3>().eval()).normalized().coeffs();
      cameras_[id] = pose;
    }
    read_sightings(data + "/VO_stereo_factors_large.txt.gz");
  }
  void read_sightings(const std::string& file) {
    mrpt::io::CFileGZInputStream in(file);
    std::string text;
    char part[4096];
    while (const std::size_t n = in.Read(part, sizeof part)) text.append(part, n);
    std::istringstream rows(text);
    for (Sighting s; rows >> s.camera >> s.landmark;) {
      double left = 0.0, right = 0.0, v = 0.0;
      rows >> left >> right >> v >> s.p_camera.x() >> s.p_camera.y() >> s.p_camera.z();
      s.z = {left, v, left - right};
      sightings_.push_back(s);
    }
  }
  Feature feature_of(const Sighting& s) const {
    Feature feature;
    feature.z = s.z;
    feature.cov = Eigen::Matrix3d::Identity();
    feature.camera = camera_;
    return feature;
  }
  /// A state with the camera where the data set has it, exactly.
  BlockId add_camera(GaussianState& state, const BlockVector& pose) const {
    return state.add({"pose", Chart::kSE3, 6, WorldRole::kPose}, pose,
                     MatrixRef(Eigen::MatrixXd::Zero(6, 6)));
  }

  std::shared_ptr<const StereoCamera> camera_;
  std::map<int, BlockVector> cameras_;
  std::vector<Sighting> sightings_;
  const StereoPoint model_{3};
};

}  // namespace

// What six printed digits leave open of every number bounds the difference.
TEST_F(GtsamStereo, TriangulatesTheSamePoints) {
  ASSERT_EQ(sightings_.size(), 8189U);
  ASSERT_EQ(cameras_.size(), 26U);
  BlockVector origin(7);
  origin << 0, 0, 0, 0, 0, 0, 1;
  GaussianState state;
  const BlockId pose = add_camera(state, origin);
  Initialization point;
  for (const Sighting& s : sightings_) {
    model_.initialize(state, pose, feature_of(s), point);
    const double right = s.z[0] - s.z[2], d = rounding(s.z[0]) + rounding(right);
    const Eigen::Vector3d by_pixel =
        point.estimate[2] / camera_->fx * Eigen::Vector3d(rounding(s.z[0]), rounding(s.z[1]), 0.0);
    for (Eigen::Index i = 0; i < 3; ++i)
      EXPECT_LE(std::abs(point.estimate[i] - s.p_camera[i]),
                by_pixel[i] + std::abs(s.p_camera[i]) * d / s.z[2] + rounding(s.p_camera[i]))
          << "camera " << s.camera << ", landmark " << s.landmark << ", axis " << i;
  }
}

// The first sighting of a point predicts the second, from another camera. The poses are first
// guesses, so this is no test of noise; but another convention of axes or of the disparity would
// show at once.
TEST_F(GtsamStereo, PredictsTheNextSighting) {
  std::map<int, Sighting> first;
  std::vector<double> errors;
  Initialization point;
  for (const Sighting& s : sightings_) {
    const auto [before, is_new] = first.emplace(s.landmark, s);
    if (is_new) continue;
    GaussianState state;
    const BlockId there = add_camera(state, cameras_.at(before->second.camera));
    model_.initialize(state, there, feature_of(before->second), point);
    const BlockId landmark = state.augment(model_.landmark_spec(), point);
    const BlockId here = add_camera(state, cameras_.at(s.camera));
    const MeasurementVector z = model_.predict(state, here, landmark, feature_of(s));
    errors.push_back((z - s.z).norm());
    before->second = s;
  }
  ASSERT_GT(errors.size(), 4000U);
  std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
  EXPECT_LT(errors[errors.size() / 2], 2.0);
}
