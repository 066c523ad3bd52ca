#include <tests/unit/batch/batch_world.hpp>

#include <gtest/gtest.h>

#include <libslam/association/nearest_neighbour.hpp>

using namespace libslam;
using namespace libslam::testing;

namespace {

Feature feature_at(double x, double y, std::int64_t id = kNoIdentity) {
  Feature feature;
  feature.id = id;
  feature.z = Eigen::Vector2d(std::hypot(x, y), std::atan2(y, x));
  feature.cov = Eigen::Vector2d(0.05 * 0.05, 0.01 * 0.01).asDiagonal();
  return feature;
}

}  // namespace

TEST(BatchRecorder, LeavesOutGivenUpLandmarksAndUnusedFeatures) {
  EkfSlamParts parts = batch_parts();
  parts.associator = std::make_unique<NearestNeighbour>(11.8, 40.0);
  parts.registry =
      LandmarkRegistry(2, 2);  // confirmed by two sightings, given up after two updates
  EkfSlam filter(std::move(parts));
  BatchRecorder recorder(filter);
  const std::vector<std::vector<Feature>> frames = {
      {feature_at(2, 0), feature_at(5, 5), feature_at(0, 4)},  // the second is never seen again
      {feature_at(2, 0), feature_at(0, 4)},
      {feature_at(0, 4), feature_at(2, 0), feature_at(-6, 0)},  // the second one is given up
      {feature_at(-6, 0), feature_at(2.25, 0)},                 // 5 sigma beside: undecided
      {feature_at(-6, 0), feature_at(2, 0)},
  };
  for (std::size_t k = 0; k < frames.size(); ++k) {
    recorder.on_motion(nullptr);
    filter.propagate(nullptr);
    recorder.on_update(frames[k], filter.update(frames[k]));
    recorder.end_step(static_cast<std::int64_t>(k), static_cast<double>(k));
  }
  const BatchLog log = recorder.log();
  ASSERT_EQ(log.landmarks.size(), 3u);
  ASSERT_EQ(filter.registry().size(), 3u);
  ASSERT_EQ(log.steps.size(), 5u);
  std::vector<int> seen(3, 0);
  const BatchEstimate estimate = recorder.estimate();
  for (const BatchStep& step : log.steps) {
    EXPECT_EQ(step.motions.size(), 1u);
    for (const BatchSighting& sighting : step.sightings) {
      ++seen[sighting.landmark];
      const Eigen::Vector2d& z = Eigen::Vector2d(sighting.feature.z);
      const Eigen::Vector2d where(z[0] * std::cos(z[1]), z[0] * std::sin(z[1]));
      EXPECT_LT((where - estimate.landmarks[sighting.landmark]).norm(), 1e-3);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(log.landmarks[i], filter.registry().landmarks()[i].id);
    EXPECT_EQ(seen[i], filter.registry().landmarks()[i].times_seen) << i;
  }
  EXPECT_EQ(log.steps[0].sightings.size(), 2u);
  EXPECT_EQ(log.steps[3].sightings.size(), 1u);
  EXPECT_EQ(estimate.path.size(), 5u);
}
