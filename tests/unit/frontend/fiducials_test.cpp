#include <map>

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>

#include <libslam/data/tag_points.hpp>
#include <libslam/frontend/fiducials.hpp>
#include <libslam/frontend/match_drawing.hpp>
#include <libslam/frontend/stereo_match.hpp>
#include <libslam/simulation/scene_renderer.hpp>

#include "stereo_fixture.hpp"

namespace libslam {
namespace {

using namespace libslam::testing;

FrontendParameters fiducial_parameters(const std::string& family) {
  FrontendParameters p;
  p.source = "fiducials";
  p.fiducials.family = family;
  p.fiducials.points = "all";
  return p;
}

/// Plates ahead of a camera at the origin, 1 m above the floor, that looks along x.
mrpt::obs::CObservationStereoImages::Ptr view_of(const std::vector<TagPlate>& plates) {
  SceneRenderer renderer(3.0);
  RenderedCamera camera{{0.0, 0.0, 0.0}, 1.0, kFocal, 0.5 * kWidth, 0.5 * kHeight, kWidth, kHeight};
  const auto left = renderer.render(camera, {}, plates);
  camera.T_world_camera.y() = -kBaseline;
  const auto right = renderer.render(camera, {}, plates);
  const auto gray = [](const std::vector<float>& image) {
    return [&image](int x, int y) {
      return static_cast<double>(image[static_cast<std::size_t>(y * kWidth + x)]);
    };
  };
  return pair_of(gray(left), gray(right));
}

Eigen::Vector3d pixels_of(const Eigen::Vector3d& p_world) {
  const StereoCamera camera{kFocal,    kFocal, 0.5 * kWidth, 0.5 * kHeight,
                            kBaseline, kWidth, kHeight,      Eigen::Isometry3d::Identity()};
  return project(camera, {-p_world.y(), 1.0 - p_world.z(), p_world.x()});
}

std::map<std::int64_t, Eigen::Vector3d> by_id(const FeatureBatch& batch) {
  std::map<std::int64_t, Eigen::Vector3d> points;
  for (const Feature& feature : batch) points.emplace(feature.id, feature.z);
  EXPECT_EQ(points.size(), batch.size());
  return points;
}

TEST(Fiducials, AprilTagsAreWhereTheTruthSays) {
  World world;
  world.landmarks = {{17, Eigen::Vector3d(2.0, 0.4, 1.2)}, {301, Eigen::Vector3d(2.6, -0.7, 0.9)}};
  std::vector<TagPlate> plates;
  for (const TrueLandmark& l : world.landmarks)
    plates.push_back(make_plate(l.id, l.position, 0.4, {}));  // towards the origin, so oblique
  Fiducials frontend(fiducial_parameters("tag36h11"), "");
  const auto points = by_id(features_of(frontend, view_of(plates)));
  ASSERT_EQ(points.size(), 10U);
  std::vector<TrueLandmark> truth = tag_corners(world, 0.4);
  truth.insert(truth.end(), world.landmarks.begin(), world.landmarks.end());
  ASSERT_EQ(truth.size(), 10U);
  for (const TrueLandmark& landmark : truth) {
    ASSERT_TRUE(points.contains(landmark.id)) << landmark.id;
    const Eigen::Vector3d error = points.at(landmark.id) - pixels_of(landmark.position);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.5) << landmark.id << ": " << error.transpose();
  }
}

TEST(Fiducials, ArucoCornersHaveTheSameOrder) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250);
  cv::Mat marker;
  cv::aruco::drawMarker(dictionary, 42, 80, marker, 1);
  constexpr int kLeft = 150, kTop = 70, kShift = 24;
  const auto gray = [&](int left) {
    return [&marker, left](int x, int y) {
      const bool inside = x >= left && x < left + 80 && y >= kTop && y < kTop + 80;
      return inside ? static_cast<double>(marker.at<std::uint8_t>(y - kTop, x - left)) : 255.0;
    };
  };
  Fiducials frontend(fiducial_parameters("DICT_6X6_250"), "");
  const auto points = by_id(features_of(frontend, pair_of(gray(kLeft), gray(kLeft - kShift))));
  ASSERT_EQ(points.size(), 5U);
  // Borders lie between pixels.
  const double u0 = kLeft - 0.5, u1 = kLeft + 79.5, v0 = kTop - 0.5, v1 = kTop + 79.5;
  const std::map<int, Eigen::Vector2d> expected = {{0, {0.5 * (u0 + u1), 0.5 * (v0 + v1)}},
                                                   {1, {u0, v0}},
                                                   {2, {u1, v0}},
                                                   {3, {u1, v1}},
                                                   {4, {u0, v1}}};
  for (const auto& [k, uv] : expected) {
    const Eigen::Vector3d& z = points.at(tag_point_id(42, k));
    EXPECT_LT((z.head<2>() - uv).cwiseAbs().maxCoeff(), 0.6) << k << ": " << z.transpose();
    EXPECT_NEAR(z[2], kShift, 0.1);
  }
}

// Two cameras take turns; each keeps its calibration, and the tables that stem from it.
TEST(Fiducials, EachCameraHasACalibrationOfItsOwn) {
  const std::vector<TagPlate> one = {make_plate(5, {2.0, 0.1, 1.0}, 0.4, {})};
  Fiducials frontend(fiducial_parameters("tag36h11"), "");
  std::map<std::string, std::shared_ptr<const StereoCamera>> cameras;
  for (int k = 0; k < 2; ++k)
    for (const auto& [label, focal] : {std::pair("ahead", kFocal), {"aside", 1.1 * kFocal}}) {
      const auto pair = view_of(one);
      pair->sensorLabel = label;
      pair->leftCamera.setIntrinsicParamsFromValues(focal, focal, 0.5 * kWidth, 0.5 * kHeight);
      pair->rightCamera = pair->leftCamera;
      pair->rightCamera.dist[0] = 1e-5;  // rectified here, by tables
      const FeatureBatch batch = features_of(frontend, pair);
      ASSERT_EQ(batch.size(), 5U) << label;
      const auto& camera = batch.front().camera;
      EXPECT_NEAR(camera->fx / focal, 1.0, 0.01) << label;
      EXPECT_EQ(batch.front().channel, label == std::string("ahead") ? 0 : 1);
      const auto [known, is_new] = cameras.emplace(label, camera);
      EXPECT_EQ(is_new, k == 0);
      EXPECT_EQ(known->second, camera) << label << ": the calibration was computed anew";
    }
}

TEST(Fiducials, ATagThatIsSeenTwiceIsNowhere) {
  const std::vector<TagPlate> twice = {make_plate(5, {2.0, 0.4, 1.0}, 0.4, {}),
                                       make_plate(5, {2.0, -0.4, 1.0}, 0.4, {})};
  Fiducials frontend(fiducial_parameters("tag36h11"), "");
  EXPECT_TRUE(features_of(frontend, view_of(twice)).empty());
}

TEST(Fiducials, PointsAreChosenByConfiguration) {
  const std::vector<TagPlate> one = {make_plate(5, {2.0, 0.1, 1.0}, 0.4, {})};
  for (const auto& [points, count] : {std::pair("centre", 1U), {"corners", 4U}, {"all", 5U}}) {
    FrontendParameters p = fiducial_parameters("tag36h11");
    p.fiducials.points = points;
    Fiducials frontend(p, "");
    EXPECT_EQ(features_of(frontend, view_of(one)).size(), count);
  }
  EXPECT_THROW(Fiducials(fiducial_parameters("tag99"), ""), std::invalid_argument);
}

TEST(Fiducials, UnusableImagesAreCounted) {
  auto pair = view_of({});
  pair->hasImageRight = false;
  Fiducials frontend(fiducial_parameters("tag36h11"), "");
  EXPECT_TRUE(features_of(frontend, pair).empty());
  EXPECT_EQ(frontend.unusable(), 1);
  EXPECT_EQ(frontend.warnings().size(), 1U);
}

TEST(MatchDrawing, IsAPngAndEmptyWithoutImages) {
  auto pair = wall_at(20.0);
  StereoFeatures frontend(stereo_parameters(), "", true);
  const FeatureBatch batch = features_of(frontend, pair);
  const auto png = draw_matches(*pair, batch);
  ASSERT_GT(png.size(), 1000U);
  EXPECT_EQ(png[1], 'P');
  EXPECT_NE(draw_matches(*pair, {}), png);
  pair->hasImageRight = false;
  EXPECT_TRUE(draw_matches(*pair, batch).empty());
}

}  // namespace
}  // namespace libslam
