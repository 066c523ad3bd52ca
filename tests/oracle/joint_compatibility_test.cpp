// Wrong pairs of joint compatibility against MRPT's on the same random frames. The table of all
// scenes: build/release/tests/bench/association-comparison.

#include <support/association_score.hpp>

#include <gtest/gtest.h>

namespace libslam::testing {
namespace {

constexpr double kGate = 0.99;

struct Totals {
  AssociationScore ours, mrpt;
};

Totals compare(const AssociationSceneOptions& options, std::uint64_t first_seed, int frames,
               bool with_mrpt) {
  Totals totals;
  JointCompatibility joint({});
  for (int frame = 0; frame < frames; ++frame) {
    AssociationScene scene(options, first_seed + static_cast<std::uint64_t>(frame));
    if (scene.features.empty()) continue;
    score(joint, scene, totals.ours);
    if (with_mrpt) score_mrpt(scene, kGate, totals.mrpt);
  }
  return totals;
}

// 60 seeds each. Measured over 150-300 other seeds: 0-.5 % wrong, 97 % of the mapped paired right;
// MRPT 14 % wrong in the wide scene and 35 % in a dense one.
TEST(JointCompatibility, WrongPairsAreRareWhereMrptHasMany) {
  AssociationSceneOptions wide;
  const Totals sparse = compare(wide, 1, 60, true);
  EXPECT_LE(sparse.ours.wrong_share(), 0.02);
  EXPECT_GE(sparse.ours.right_share(), 0.9);
  EXPECT_GE(sparse.mrpt.wrong_share(), 0.05);
  AssociationSceneOptions dense;
  dense.area_per_landmark = 3.0;
  dense.max_range = 8.0;
  const Totals close = compare(dense, 1, 60, true);
  EXPECT_LE(close.ours.wrong_share(), 0.02);
  EXPECT_GE(close.ours.right_share(), 0.8);
  EXPECT_GE(close.mrpt.wrong_share(), 0.2);
}

TEST(JointCompatibility, ObjectsThatAreNotMappedAreRarelyPaired) {
  AssociationSceneOptions options;
  options.unmapped = 3;
  const Totals totals = compare(options, 1, 100, false);
  EXPECT_LE(totals.ours.wrong_share(), 0.02);
  EXPECT_GE(totals.ours.right_share(), 0.9);
}

// CPU time of the thread, so that other programs do not count; 15 ms is the worst of 150 frames
// measured, and the budget bounds it.
TEST(JointCompatibility, TheHardestFrameStaysBelowTwentyMilliseconds) {
#ifndef NDEBUG
  GTEST_SKIP() << "a time of optimized code";
#endif
  AssociationSceneOptions options;
  options.landmarks = 200;
  options.area_per_landmark = 3.0;
  options.observations = 30;
  options.sigma_position = 1.0;
  options.sigma_heading *= 2.0;
  EXPECT_LE(compare(options, 1, 40, false).ours.slowest_ms(), 20.0);
}

}  // namespace
}  // namespace libslam::testing
