#include <random>
#include <support/association_score.hpp>
#include <support/shifted_points.hpp>

#include <gtest/gtest.h>

#include <libslam/association/sequential_compatibility.hpp>

using namespace libslam;
using libslam::testing::AssociationScene;
using libslam::testing::AssociationSceneOptions;
using libslam::testing::AssociationScore;
using libslam::testing::ShiftedPoints;

namespace {

const double kGate = chi_square_quantile(0.99, 2), kNewGate = chi_square_quantile(0.999, 2);

std::vector<Verdict> associate(ShiftedPoints& points) {
  std::vector<Feature> features(points.features());
  std::vector<Verdict> verdicts;
  SequentialCompatibility(kGate, kNewGate).associate(features, points.registry(), points, verdicts);
  return verdicts;
}

}  // namespace

// A shift by most of the distance between two landmarks: each point alone is nearer to the wrong
// one. The first, which stands alone, says what the shift is.
TEST(SequentialCompatibility, TheFirstFeaturePutsTheOthersRight) {
  const Eigen::Vector2d shift(2.0, 0.0);
  const std::vector<Eigen::Vector2d> map = {{30, 0}, {0, 0}, {3, 0}};
  ShiftedPoints points({map[0] + shift, map[1] + shift}, map, 2.0, 0.1);
  const auto verdicts = associate(points);
  EXPECT_EQ(verdicts[0].outcome, Outcome::kPaired);
  EXPECT_EQ(verdicts[0].landmark, 0u);
  EXPECT_EQ(verdicts[1].outcome, Outcome::kPaired);
  EXPECT_EQ(verdicts[1].landmark, 1u);
  // The other way round the first takes the nearest.
  ShiftedPoints reversed({map[1] + shift, map[0] + shift}, map, 2.0, 0.1);
  EXPECT_EQ(associate(reversed)[0].landmark, 2u);
}

TEST(SequentialCompatibility, NewIsWhatIsFarFromAllGivenThePairsBefore) {
  const std::vector<Eigen::Vector2d> map = {{30, 0}, {0, 0}};
  // Alone, (2, 0) could be the second landmark, shifted; after the first pair it cannot.
  ShiftedPoints points({{30, 0}, {2, 0}, {0.35, 0.0}}, map, 2.0, 0.1);
  const auto verdicts = associate(points);
  EXPECT_EQ(verdicts[0].outcome, Outcome::kPaired);
  EXPECT_EQ(verdicts[1].outcome, Outcome::kNew);
  // .35 m off with a sigma of .14 given the first pair: 6.1 is within the gate of 9.2; .45 is
  // between the gates.
  EXPECT_EQ(verdicts[2].outcome, Outcome::kPaired);
  ShiftedPoints between({{30, 0}, {0.48, 0.0}}, map, 2.0, 0.1);
  EXPECT_EQ(associate(between)[1].outcome, Outcome::kAmbiguous);
}

TEST(SequentialCompatibility, NoLandmarkIsTakenTwice) {
  const std::vector<Eigen::Vector2d> map = {{0, 0}};
  ShiftedPoints points({{0, 0}, {0.1, 0}}, map, 1.0, 0.1);
  const auto verdicts = associate(points);
  EXPECT_EQ(verdicts[0].outcome, Outcome::kPaired);
  EXPECT_EQ(verdicts[1].outcome, Outcome::kAmbiguous);
}

TEST(SequentialCompatibility, AnEmptyMapMakesEverythingNew) {
  ShiftedPoints points({{0, 0}, {1, 0}}, {}, 1.0, 0.1);
  for (const Verdict& verdict : associate(points)) EXPECT_EQ(verdict.outcome, Outcome::kNew);
}

TEST(SequentialCompatibility, RefusesGatesInTheWrongOrder) {
  EXPECT_THROW(SequentialCompatibility(0.0, 1.0), std::invalid_argument);
  EXPECT_THROW(SequentialCompatibility(3.0, 2.0), std::invalid_argument);
}

// On easy scenes, where joint compatibility makes no mistake, the two agree; the first pairs of
// hard ones may be wrong, which is the price of O(pairs^2).
TEST(SequentialCompatibility, AgreesWithJointCompatibilityOnEasyScenes) {
  AssociationSceneOptions easy;
  easy.area_per_landmark = 100.0;
  easy.max_range = 30.0;
  easy.sigma_position = 0.1;
  easy.sigma_heading = 0.01;
  SequentialCompatibility sequential(kGate, kNewGate);
  JointCompatibility joint({});
  AssociationScore ours, theirs;
  int both = 0, differ = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    AssociationScene scene(easy, seed);
    std::vector<Verdict> verdicts, reference;
    auto test = scene.test();
    sequential.associate(scene.features, scene.registry, test, verdicts);
    ours.add(scene, verdicts, 0.0);
    auto again = scene.test();
    joint.associate(scene.features, scene.registry, again, reference);
    theirs.add(scene, reference, 0.0);
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      if (verdicts[i].outcome != Outcome::kPaired || reference[i].outcome != Outcome::kPaired)
        continue;
      ++both;
      differ += verdicts[i].landmark != reference[i].landmark;
    }
  }
  // Measured: one pair of 500 differs and is wrong, two landmarks that stand side by side.
  EXPECT_GE(both, 400);
  EXPECT_LE(differ, 3);
  EXPECT_LE(ours.wrong_share(), 0.006);
  EXPECT_LE(theirs.wrong_share(), 0.006);
  EXPECT_GE(ours.right_share(), 0.96);  // the gate rejects one in a hundred
  EXPECT_LE(ours.wrongly_new, 2);
}
