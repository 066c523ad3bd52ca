#include <algorithm>
#include <random>
#include <set>
#include <support/association_scene.hpp>
#include <support/shifted_points.hpp>
#include <tuple>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <libslam/association/joint_compatibility.hpp>
#include <libslam/association/known.hpp>
#include <libslam/association/nearest_neighbour.hpp>
#include <libslam/state/chi_square.hpp>

using namespace libslam;
using libslam::testing::ShiftedPoints;

namespace {

constexpr double kGate = 0.99, kNewGate = 0.999;

ShiftedPoints random_problem(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(0.0, 6.0);
  std::uniform_int_distribution<int> count(2, 4);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector2d> seen, map;
  const Eigen::Vector2d shift(normal(random), normal(random));
  const int landmarks = count(random), features = count(random);
  for (int k = 0; k < landmarks; ++k) map.emplace_back(place(random), place(random));
  for (int i = 0; i < features; ++i) {
    const Eigen::Vector2d object(place(random), place(random));
    const bool mapped = i < landmarks && i != 1;
    const Eigen::Vector2d& p = mapped ? map[static_cast<std::size_t>(i)] : object;
    seen.emplace_back(p + shift + 0.2 * Eigen::Vector2d(normal(random), normal(random)));
  }
  return {seen, map, 1.0, 0.2};
}

/// The features with candidates, in the order of the search, and their candidates.
std::vector<std::pair<std::size_t, std::vector<std::size_t>>> candidates_of(ShiftedPoints& points) {
  std::vector<std::pair<std::size_t, std::vector<std::size_t>>> result;
  const double gate = chi_square_quantile(kGate, 2);
  for (std::size_t i = 0; i < points.features(); ++i) {
    std::vector<std::size_t> fitting;
    for (std::size_t k = 0; k < points.landmarks(); ++k)
      if (points.test(i, k, gate)->mahalanobis2 <= gate) fitting.push_back(k);
    result.emplace_back(i, fitting);
  }
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.second.size(), a.first) < std::tuple(b.second.size(), b.first);
  });
  return result;
}

struct Best {
  std::size_t size = 0;
  double cost = 0.0;
};

/// Every one-to-one hypothesis. `ordered`: compatible after each pair in the order of the search,
/// as in the paper; else as a whole alone.
Best enumerate(ShiftedPoints& points, bool ordered) {
  const auto candidates = candidates_of(points);
  Best best;
  std::vector<Pairing> pairs;
  std::set<std::size_t> taken;
  const auto visit = [&](const auto& self, std::size_t depth) -> void {
    if (depth == candidates.size()) {
      if (pairs.empty() || !points.compatible(pairs, kGate)) return;
      const Match joint = points.joint(pairs);
      const double cost = joint.mahalanobis2 + joint.log_det;
      if (pairs.size() > best.size || (pairs.size() == best.size && cost < best.cost))
        best = {pairs.size(), cost};
      return;
    }
    for (const std::size_t landmark : candidates[depth].second) {
      if (taken.count(landmark) > 0) continue;
      pairs.push_back({candidates[depth].first, landmark});
      taken.insert(landmark);
      if (!ordered || points.compatible(pairs, kGate)) self(self, depth + 1);
      taken.erase(landmark);
      pairs.pop_back();
    }
    self(self, depth + 1);
  };
  visit(visit, 0);
  return best;
}

}  // namespace

TEST(IncrementalInnovation, OnePairAtATimeIsTheWholeMatrix) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    ShiftedPoints points = random_problem(random);
    std::vector<Pairing> pairs;
    for (std::size_t i = 0; i < std::min(points.features(), points.landmarks()); ++i)
      pairs.push_back({i, i});
    const Match whole = points.joint(pairs);
    IncrementalInnovation joint;
    joint.reset(points);
    joint.extend(pairs.size() - 1);  // taken and given up: leaves no trace
    joint.push();
    joint.pop();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      joint.extend(i);
      joint.push();
    }
    EXPECT_NEAR(joint.mahalanobis2(), whole.mahalanobis2, 1e-9 * (1.0 + whole.mahalanobis2));
    EXPECT_NEAR(joint.log_det(), whole.log_det, 1e-9 * (1.0 + std::abs(whole.log_det)));
  }
}

TEST(JointCompatibility, FindsWhatEnumerationFinds) {
  std::mt19937_64 random(7);
  JointCompatibility association({kGate, kNewGate});
  std::vector<Verdict> verdicts;
  std::size_t equal = 0;
  constexpr std::size_t kTrials = 400;
  for (std::size_t trial = 0; trial < kTrials; ++trial) {
    ShiftedPoints points = random_problem(random);
    const Best ordered = enumerate(points, true), any = enumerate(points, false);
    association.associate(std::vector<Feature>(points.features()), points.registry(), points,
                          verdicts);
    ASSERT_FALSE(association.exhausted());
    const std::vector<Pairing> found = association.hypothesis();
    // The greedy start takes pairs in other orders, which may pass where the order of the search
    // does not: never worse than the paper, never better than the best of all.
    ASSERT_GE(found.size(), ordered.size) << trial;
    ASSERT_LE(found.size(), any.size) << trial;
    if (found.empty()) continue;
    ASSERT_TRUE(points.compatible(found, kGate)) << trial;
    const Match joint = points.joint(found);
    if (found.size() == ordered.size) {
      ASSERT_LE(joint.mahalanobis2 + joint.log_det, ordered.cost + 1e-9) << trial;
      ++equal;
    }
  }
  EXPECT_GT(equal, kTrials * 9 / 10);
}

TEST(JointCompatibility, PairsNoLessThanTheCompatiblePartOfNearestNeighbour) {
  std::mt19937_64 random(11);
  JointCompatibility association({kGate, kNewGate});
  NearestNeighbour nearest(chi_square_quantile(kGate, 2), chi_square_quantile(kNewGate, 2));
  std::vector<Verdict> verdicts, greedy;
  for (int trial = 0; trial < 400; ++trial) {
    ShiftedPoints points = random_problem(random);
    const std::vector<Feature> features(points.features());
    nearest.associate(features, points.registry(), points, greedy);
    std::vector<Pairing> part;
    for (const auto& [feature, fitting] : candidates_of(points)) {
      if (greedy[feature].outcome != Outcome::kPaired) continue;
      part.push_back({feature, greedy[feature].landmark});
      if (!points.compatible(part, kGate)) part.pop_back();
    }
    association.associate(features, points.registry(), points, verdicts);
    ASSERT_GE(association.hypothesis().size(), part.size()) << trial;
  }
}

TEST(JointCompatibility, OneShiftForAllDecidesWhereSinglePairsCannot) {
  // Landmarks 1 m apart on a line, everything seen 1 m further: each point fits its neighbour
  // exactly, but all of them together only their own landmarks.
  ShiftedPoints points({{1.0, 0.0}, {2.0, 0.0}, {3.0, 0.0}, {1.0, 3.0}},
                       {{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}, {0.0, 3.0}}, 1.0, 0.1);
  std::vector<Verdict> verdicts;
  JointCompatibility({kGate, kNewGate})
      .associate(std::vector<Feature>(4), points.registry(), points, verdicts);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(verdicts[i].outcome, Outcome::kPaired) << i;
    EXPECT_EQ(verdicts[i].landmark, i);
  }
}

TEST(JointCompatibility, WhatTwoHypothesesDenyEachOtherIsNotUsed) {
  // One point between two landmarks: both hypotheses are equally likely.
  ShiftedPoints points({{0.5, 0.0}}, {{0.0, 0.0}, {1.0, 0.0}}, 1.0, 0.1);
  std::vector<Verdict> verdicts;
  JointCompatibility association({kGate, kNewGate});
  association.associate(std::vector<Feature>(1), points.registry(), points, verdicts);
  EXPECT_EQ(verdicts[0].outcome, Outcome::kAmbiguous);
  EXPECT_EQ(association.hypothesis().size(), 1u);
}

TEST(JointCompatibility, APointIsNewIfItIsFarFromAllLandmarksGivenTheOthers) {
  // Alone, the last point fits landmark 0 within the large common error; given the others it does
  // not. Between the gates it is neither.
  for (const auto& [y, outcome] : {std::pair{0.8, Outcome::kNew}, {0.37, Outcome::kAmbiguous}}) {
    ShiftedPoints points({{0.0, 0.0}, {5.0, 0.0}, {0.0, 5.0}, {5.0, 5.0}, {5.0, y}},
                         {{0.0, 0.0}, {5.0, 0.0}, {0.0, 5.0}, {5.0, 5.0}}, 1.0, 0.1);
    std::vector<Verdict> verdicts;
    JointCompatibility({kGate, kNewGate})
        .associate(std::vector<Feature>(5), points.registry(), points, verdicts);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(verdicts[i].outcome, Outcome::kPaired) << i;
    EXPECT_EQ(verdicts[4].outcome, outcome) << y;
  }
}

TEST(JointCompatibility, TheBudgetBoundsTheSearchAndTheResultIsStillCompatible) {
  libslam::testing::AssociationSceneOptions dense;
  dense.landmarks = 200;
  dense.area_per_landmark = 2.0;
  dense.observations = 25;
  dense.unmapped = 5;
  libslam::testing::AssociationScene scene(dense, 5);
  JointCompatibilityOptions options{kGate, kNewGate};
  options.budget = 2000;
  JointCompatibility association(options);
  std::vector<Verdict> verdicts, again;
  PairTest test = scene.test();
  association.associate(scene.features, scene.registry, test, verdicts);
  EXPECT_TRUE(association.exhausted());
  EXPECT_GE(association.hypothesis().size(), 5u);
  JointCompatibility(options).associate(scene.features, scene.registry, test, again);
  const double new_gate = chi_square_quantile(kNewGate, 2);
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    EXPECT_EQ(verdicts[i].outcome, again[i].outcome);
    EXPECT_EQ(verdicts[i].landmark, again[i].landmark);
    // A better hypothesis might pair it: new is only what fits nothing by itself.
    if (verdicts[i].outcome != Outcome::kNew) continue;
    for (std::size_t k = 0; k < scene.registry.size(); ++k) {
      const auto match = test.test(i, k, new_gate);
      EXPECT_FALSE(match && match->mahalanobis2 <= new_gate) << i << ' ' << k;
    }
  }
}

TEST(JointCompatibility, RefusesGatesInTheWrongOrder) {
  EXPECT_THROW(JointCompatibility({0.99, 0.9}), std::invalid_argument);
  EXPECT_THROW(JointCompatibility({0.0, 0.9}), std::invalid_argument);
  EXPECT_THROW(JointCompatibility({0.99, 1.0}), std::invalid_argument);
}

// The filter's answers are those of its covariance.
TEST(PairTest, JointCovarianceIsHPHt) {
  libslam::testing::AssociationScene scene({}, 2);
  PairTest test = scene.test();
  const std::vector<Pairing> pairs{{0, 3}, {1, 4}, {2, 3}};
  test.select(pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto single = test.test(pairs[i].feature, pairs[i].landmark, 1e9);
    const Eigen::MatrixXd s = test.covariance(i, i);
    const Eigen::VectorXd nu = test.innovation(i);
    ASSERT_TRUE(single.has_value());
    EXPECT_NEAR(single->mahalanobis2, nu.dot(s.ldlt().solve(nu)), 1e-6 * single->mahalanobis2);
    for (std::size_t k = 0; k < pairs.size(); ++k)
      EXPECT_TRUE(test.covariance(i, k).isApprox(test.covariance(k, i).transpose(), 1e-9));
  }
}
