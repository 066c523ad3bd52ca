#include <gtest/gtest.h>

#include <libslam/association/landmark_registry.hpp>

using namespace libslam;

TEST(LandmarkRegistry, ConfirmsAfterSightingsAndGivesUpTheRest) {
  LandmarkRegistry registry(3, 4);
  registry.add(BlockId{10}, 7);
  registry.add(BlockId{11}, kNoIdentity);
  registry.record_sighting(0);
  registry.record_sighting(0);
  EXPECT_TRUE(registry.landmarks()[0].confirmed);
  EXPECT_FALSE(registry.landmarks()[1].confirmed);
  for (int update = 0; update < 4; ++update) EXPECT_TRUE(registry.record_update().empty());
  const std::vector<BlockId> given_up = registry.record_update();
  ASSERT_EQ(given_up.size(), 1u);
  EXPECT_EQ(given_up[0], BlockId{11});
  ASSERT_EQ(registry.size(), 1u);
  EXPECT_EQ(*registry.find(7), 0u);
  EXPECT_EQ(registry.landmarks()[0].times_seen, 3);
}

TEST(LandmarkRegistry, RunningNumbersAreNeverReused) {
  LandmarkRegistry registry(2, 1, 100);
  registry.add(BlockId{1}, kNoIdentity);
  EXPECT_EQ(registry.landmarks()[0].id, 100);
  registry.record_update();
  ASSERT_EQ(registry.record_update().size(), 1u);
  registry.add(BlockId{2}, kNoIdentity);
  EXPECT_EQ(registry.landmarks()[0].id, 101);
  EXPECT_FALSE(registry.find(100).has_value());
}

TEST(LandmarkRegistry, WithoutPruningNothingIsGivenUp) {
  LandmarkRegistry registry(5, 0);
  registry.add(BlockId{1}, 3);
  for (int update = 0; update < 100; ++update) ASSERT_TRUE(registry.record_update().empty());
  EXPECT_EQ(registry.size(), 1u);
}

TEST(LandmarkRegistry, GoesOnFromAnEarlierRun) {
  LandmarkRegistry registry(3, 4, 100);
  registry.restore({BlockId{5}, 40, 2, 4, false});
  registry.restore({BlockId{6}, 107, 9, 30, true});
  registry.number_from(108);
  registry.number_from(50);
  EXPECT_EQ(*registry.find(107), 1u);
  EXPECT_THROW(registry.restore({BlockId{7}, 107, 1, 0, true}), std::invalid_argument);
  EXPECT_THROW(registry.restore({BlockId{7}, kNoIdentity, 1, 0, true}), std::invalid_argument);
  registry.add(BlockId{7}, kNoIdentity);
  EXPECT_EQ(registry.landmarks()[2].id, 108);
  EXPECT_EQ(registry.next_number(), 109);
  EXPECT_EQ(registry.record_update(), std::vector<BlockId>{BlockId{5}});
}

TEST(LandmarkRegistry, ForgetsWhatIsNotSeenForSomeUpdates) {
  LandmarkRegistry registry(1, 0, 0, 2);
  registry.add(BlockId{1}, 10);
  registry.add(BlockId{2}, 20);
  EXPECT_TRUE(registry.record_update().empty());  // the update that added them
  registry.record_sighting(0);
  EXPECT_TRUE(registry.record_update().empty());  // one without the second
  registry.record_sighting(0);
  EXPECT_EQ(registry.record_update(), std::vector<BlockId>{BlockId{2}});
  EXPECT_EQ(*registry.find(10), 0U);
  EXPECT_FALSE(registry.find(20).has_value());
}

TEST(LandmarkRegistry, ClearsToAnEmptyMapThatGoesOnNumbering) {
  LandmarkRegistry registry(1, 0, 5);
  registry.add(BlockId{1}, kNoIdentity);
  EXPECT_EQ(registry.clear(), std::vector<BlockId>{BlockId{1}});
  EXPECT_EQ(registry.size(), 0U);
  EXPECT_FALSE(registry.find(5).has_value());
  registry.add(BlockId{2}, kNoIdentity);
  EXPECT_EQ(registry.landmarks()[0].id, 6);
}

TEST(LandmarkRegistry, TheExtentGrowsAndAnEndThatMovesTakesItsUncertaintyAlong) {
  LandmarkRegistry registry(1, 0);
  registry.add(BlockId{1}, 3, nullptr, Extent{0.0, 2.0, 0.1, 0.2});
  registry.record_sighting(0, nullptr, Extent{-1.0, 1.5, 0.3, 0.4});
  registry.record_sighting(0);
  const Extent extent = *registry.landmarks()[0].extent;
  EXPECT_EQ(extent.begin, -1.0);
  EXPECT_EQ(extent.sigma_begin, 0.3);
  EXPECT_EQ(extent.end, 2.0);
  EXPECT_EQ(extent.sigma_end, 0.2);
  registry.add(BlockId{2}, 4);
  registry.record_sighting(1, nullptr, Extent{5.0, 6.0, 0.1, 0.1});
  EXPECT_EQ(registry.landmarks()[1].extent->begin, 5.0);
}

TEST(LandmarkRegistry, AMergedLandmarkInheritsTheSightings) {
  LandmarkRegistry registry(3, 0);
  registry.add(BlockId{1}, 3, nullptr, Extent{0.0, 2.0, 0.1, 0.2});
  registry.record_update();
  registry.record_sighting(0);
  registry.add(BlockId{2}, 4, nullptr, Extent{7.0, 8.0, 0.1, 0.2});
  registry.mark_prior_judged(1);
  registry.add(BlockId{3}, 5);
  registry.record_update();
  ASSERT_FALSE(registry.landmarks()[0].confirmed);
  EXPECT_EQ(registry.merge(0, 1, Extent{1.0, 3.0, 0.3, 0.4}), BlockId{2});
  ASSERT_EQ(registry.size(), 2u);
  const RegisteredLandmark& kept = registry.landmarks()[0];
  EXPECT_EQ(kept.block, BlockId{1});
  EXPECT_EQ(kept.times_seen, 3);
  EXPECT_EQ(kept.updates, 2);
  EXPECT_EQ(kept.unseen, 1);
  EXPECT_TRUE(kept.confirmed);
  EXPECT_TRUE(kept.prior_judged);
  EXPECT_EQ(kept.extent->end, 3.0);
  EXPECT_EQ(kept.extent->sigma_end, 0.4);
  EXPECT_FALSE(registry.find(4).has_value());
  EXPECT_EQ(*registry.find(5), 1u);
}

TEST(LandmarkRegistry, MergingIntoALaterOneKeepsItsPlaceInOrder) {
  LandmarkRegistry registry(1, 0);
  registry.add(BlockId{1}, 3);
  registry.add(BlockId{2}, 4);
  registry.record_sighting(1);
  EXPECT_EQ(registry.merge(1, 0, std::nullopt), BlockId{1});
  ASSERT_EQ(registry.size(), 1u);
  EXPECT_EQ(registry.landmarks()[0].id, 4);
  EXPECT_EQ(registry.landmarks()[0].times_seen, 3);
}
