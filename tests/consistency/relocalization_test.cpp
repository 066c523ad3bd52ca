// Kidnapped to anywhere in a mapped world, nothing known of the pose: range .2 m, bearing 2 deg,
// 30 m, 180 deg, at least four mapped landmarks in the first view, twenty frames of 0.6 m.

#include <fstream>
#include <string>
#include <support/kidnap_world.hpp>

#include <gtest/gtest.h>

namespace libslam::testing {
namespace {

struct Tally {
  int trials = 0, found = 0, wrong = 0;
  double nees = 0.0;
  double found_share() const { return static_cast<double>(found) / trials; }
  double mean_nees() const { return nees / (found - wrong); }
};

void run(KidnapWorld& world, int kidnaps, Tally& tally) {
  for (int i = 0; i < kidnaps; ++i) {
    const auto outcome = world.kidnap({});
    if (!outcome) continue;
    ++tally.trials;
    if (!outcome->frame) continue;
    ++tally.found;
    if (outcome->right)
      tally.nees += outcome->nees;
    else
      ++tally.wrong;
  }
}

std::vector<Eigen::Vector2d> webmap() {
  std::ifstream in(LIBSLAM_DATASETS_DIR "/webmap/landmarks.csv");
  std::string header;
  std::getline(in, header);
  std::vector<Eigen::Vector2d> points;
  int id = 0;
  double x = 0.0, y = 0.0;
  for (char comma = 0; in >> id >> comma >> x >> comma >> y;) points.emplace_back(x, y);
  return points;
}

void expect_sound(const Tally& tally, int at_least) {
  EXPECT_GE(tally.trials, at_least);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GE(tally.found_share(), 0.95);
  // The mean of 3 degrees of freedom, within what linearized polar noise leaves of it.
  EXPECT_NEAR(tally.mean_nees(), 3.0, 0.8);
}

TEST(Relocalization, Webmap) {
  const auto landmarks = webmap();
  ASSERT_EQ(landmarks.size(), 35u);
  for (const double unmapped : {0.0, 0.3}) {
    KidnapOptions options;
    options.unmapped = unmapped;
    Tally tally;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      KidnapWorld world(landmarks, options, seed);
      run(world, 50, tally);
    }
    expect_sound(tally, 900);
  }
}

TEST(Relocalization, RandomDenseWorlds) {
  for (const double unmapped : {0.0, 0.3}) {
    KidnapOptions options;
    options.unmapped = unmapped;
    Tally tally;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      KidnapWorld world(scattered(100, 150.0, seed), options, 5000 + seed);
      run(world, 10, tally);
    }
    expect_sound(tally, 950);
  }
}

// Nothing that is seen is in the map: every answer would be wrong.
TEST(Relocalization, OutsideOfTheMapThereIsNoAnswer) {
  int answers = 0;
  const double pi = 3.14159265358979323846;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<PlanarPoint> map;
    for (const auto& p : scattered(100, 150.0, seed))
      map.push_back({p, 0.01 * Eigen::Matrix2d::Identity()});
    const ConstellationIndex index(std::move(map), 80.0, 30.0);
    for (std::uint64_t place = 0; place < 100; ++place) {
      std::vector<PlanarPoint> seen;
      for (const auto& p : scattered(4 + static_cast<int>(place % 5), 40.0, 1000 * seed + place))
        seen.push_back({p - Eigen::Vector2d(10.0, 20.0), 0.1 * Eigen::Matrix2d::Identity()});
      const SensorView view{Eigen::Vector3d::Zero(), 30.0, pi};
      answers +=
          match_constellation(index, seen, {&view, 1}).verdict == ConstellationVerdict::kFound;
    }
  }
  EXPECT_EQ(answers, 0);
}

}  // namespace
}  // namespace libslam::testing
