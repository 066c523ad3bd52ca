#include <map>
#include <set>
#include <tests/support/pairwise_compatibility.hpp>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/association/nearest_neighbour.hpp>

using namespace libslam;

namespace {

/// Squared distances given by hand.
class Table final : public libslam::testing::PairwiseCompatibility {
 public:
  explicit Table(std::vector<std::vector<double>> distance2) : distance2_(std::move(distance2)) {}
  std::optional<Match> test(std::size_t feature, std::size_t landmark, double limit) override {
    const double d2 = distance2_[feature][landmark];
    if (d2 > 10.0 * limit)
      return std::nullopt;  // "certainly far": any bound above the limit will do
    return Match{d2, 0.0};
  }

 private:
  std::vector<std::vector<double>> distance2_;
};

LandmarkRegistry registry_of(std::vector<std::int64_t> ids) {
  LandmarkRegistry registry(1, 0, 1000);
  int block = 0;
  for (const auto id : ids) registry.add(BlockId{block++}, id);
  return registry;
}

std::vector<Feature> features_with(std::vector<std::int64_t> ids) {
  std::vector<Feature> features(ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) features[i].id = ids[i];
  return features;
}

}  // namespace

TEST(KnownAssociation, PairsGatesAndCreatesByIdentity) {
  const auto registry = registry_of({5, 6, 7});
  const auto features = features_with({6, 9, 5, kNoIdentity, 6});
  Table table({{9, 1, 9}, {0, 0, 0}, {50, 9, 9}, {0, 0, 0}, {9, 1, 9}});
  std::vector<Verdict> verdicts;
  KnownAssociation(9.21).associate(features, registry, table, verdicts);
  ASSERT_EQ(verdicts.size(), 5u);
  EXPECT_EQ(verdicts[0].outcome, Outcome::kPaired);
  EXPECT_EQ(verdicts[0].landmark, 1u);
  EXPECT_EQ(verdicts[1].outcome, Outcome::kNew);
  EXPECT_EQ(verdicts[2].outcome, Outcome::kGated);
  EXPECT_EQ(verdicts[3].outcome, Outcome::kAmbiguous);  // no identity
  EXPECT_EQ(verdicts[4].outcome, Outcome::kAmbiguous);  // the identity is used up
}

TEST(KnownAssociation, FeaturesWithoutIdentityTakeWhatIsLeft) {
  const auto registry = registry_of({5, 6});
  const auto features = features_with({6, kNoIdentity, kNoIdentity});
  // Both unidentified features are nearest to landmark 6, which its identity holds already.
  Table table({{9, 1}, {2, 0.1}, {80, 0.1}});
  KnownAssociation known(9.21, std::make_unique<NearestNeighbour>(9.21, 40.0));
  std::vector<Verdict> verdicts;
  known.associate(features, registry, table, verdicts);
  EXPECT_EQ(verdicts[0].landmark, 1u);
  EXPECT_EQ(verdicts[1].outcome, Outcome::kPaired);
  EXPECT_EQ(verdicts[1].landmark, 0u);
  EXPECT_EQ(verdicts[2].outcome, Outcome::kNew);
}

TEST(NearestNeighbour, TheZoneBetweenTheGatesIsDropped) {
  const auto registry = registry_of({0});
  const auto features = features_with({kNoIdentity});
  NearestNeighbour nearest(9.0, 40.0);
  std::vector<Verdict> verdicts;
  const std::pair<double, Outcome> cases[] = {{8.9, Outcome::kPaired},
                                              {9.1, Outcome::kAmbiguous},
                                              {39.9, Outcome::kAmbiguous},
                                              {40.1, Outcome::kNew},
                                              {1e9, Outcome::kNew}};
  for (const auto& [distance2, outcome] : cases) {
    Table table(std::vector<std::vector<double>>{{distance2}});
    nearest.associate(features, registry, table, verdicts);
    EXPECT_EQ(verdicts[0].outcome, outcome) << distance2;
  }
}

TEST(NearestNeighbour, TheLoserOfALandmarkTakesItsSecondChoiceOrNone) {
  const auto registry = registry_of({0, 1});
  const auto features = features_with({kNoIdentity, kNoIdentity});
  std::vector<Verdict> verdicts;
  Table second_choice(std::vector<std::vector<double>>{{7.0, 8.0}, {0.5, 100.0}});
  // 2 ln 20 = 6.0: a clear winner; the loser's second choice is inside the gate, or it has none.
  NearestNeighbour(9.0, 40.0).associate(features, registry, second_choice, verdicts);
  EXPECT_EQ(verdicts[1].landmark, 0u);
  EXPECT_EQ(verdicts[0].landmark, 1u);
  Table clear(std::vector<std::vector<double>>{{7.0, 100.0}, {0.5, 100.0}});
  NearestNeighbour(9.0, 40.0).associate(features, registry, clear, verdicts);
  EXPECT_EQ(verdicts[1].outcome, Outcome::kPaired);
  EXPECT_EQ(verdicts[0].outcome, Outcome::kAmbiguous);
}

TEST(NearestNeighbour, AnUndecidedContestUsesNeither) {
  const auto registry = registry_of({0, 1});
  const auto features = features_with({kNoIdentity, kNoIdentity});
  Table table(std::vector<std::vector<double>>{{1.0, 100.0}, {0.5, 100.0}});
  std::vector<Verdict> verdicts;
  NearestNeighbour(9.0, 40.0).associate(features, registry, table, verdicts);
  EXPECT_EQ(verdicts[0].outcome, Outcome::kAmbiguous);
  EXPECT_EQ(verdicts[1].outcome, Outcome::kAmbiguous);
}

TEST(NearestNeighbour, RefusesGatesInTheWrongOrder) {
  EXPECT_THROW(NearestNeighbour(9.0, 5.0), std::invalid_argument);
  EXPECT_THROW(NearestNeighbour(0.0, 5.0), std::invalid_argument);
}

RC_GTEST_PROP(NearestNeighbour, IsOneToOneAndNeverBreaksAGate, ()) {
  const auto rows = *rc::gen::inRange<std::size_t>(1, 8),
             cols = *rc::gen::inRange<std::size_t>(1, 8);
  std::vector<std::vector<double>> distance2(rows, std::vector<double>(cols));
  for (auto& row : distance2)
    for (auto& value : row) value = 0.1 * *rc::gen::inRange(0, 600);
  const auto registry = registry_of(std::vector<std::int64_t>(cols, kNoIdentity));
  const std::vector<Feature> features(rows);
  Table table(distance2);
  std::vector<Verdict> verdicts;
  NearestNeighbour(9.0, 40.0).associate(features, registry, table, verdicts);
  std::set<std::size_t> taken;
  for (std::size_t i = 0; i < rows; ++i) {
    const double nearest = *std::min_element(distance2[i].begin(), distance2[i].end());
    if (verdicts[i].outcome == Outcome::kPaired) {
      RC_ASSERT(taken.insert(verdicts[i].landmark).second);
      RC_ASSERT(distance2[i][verdicts[i].landmark] <= 9.0);
    } else if (verdicts[i].outcome == Outcome::kNew) {
      RC_ASSERT(nearest > 40.0);
    } else {
      RC_ASSERT(nearest <= 40.0);
    }
  }
}
