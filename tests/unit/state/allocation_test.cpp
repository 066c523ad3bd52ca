// A filter step in steady state allocates nothing: counted at malloc, which operator new and Eigen
// use.

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <libslam/association/sequential_compatibility.hpp>
#include <libslam/filter/ekf.hpp>
#include <libslam/filter/pair_test.hpp>
#include <libslam/frontend/line_extraction.hpp>
#include <libslam/measurement/line.hpp>
#include <libslam/measurement/range_bearing.hpp>
#include <libslam/policy/process_scale.hpp>
#include <libslam/policy/sage_husa.hpp>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LIBSLAM_COUNTS_MALLOC 0
#else
#define LIBSLAM_COUNTS_MALLOC 1
#endif

#if LIBSLAM_COUNTS_MALLOC
namespace {
std::atomic<long> g_allocations{0};
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);     // NOLINT(bugprone-reserved-identifier)
void* malloc(std::size_t size) noexcept {  // counts, then glibc's own
  g_allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}
}
#endif

using namespace libslam;

TEST(Allocation, AStepWithAdaptationIsFreeOfItInSteadyState) {
#if !LIBSLAM_COUNTS_MALLOC
  GTEST_SKIP() << "sanitizers own malloc";
#else
  for (const char* frame : {"standard", "right_invariant"}) {
    std::mt19937_64 random(41);
    std::uniform_real_distribution<double> uniform(-20.0, 20.0);
    GaussianState state;
    const BlockId pose = state.add({"pose", Chart::kSE2, 3, WorldRole::kPose},
                                   Eigen::Vector3d::Zero(), 1e-4 * Eigen::Matrix3d::Identity());
    const RangeBearing model;
    Feature feature;
    feature.cov = 1e-2 * Eigen::Matrix2d::Identity();
    std::vector<BlockId> landmarks;
    std::vector<Feature> features;
    for (int i = 0; i < 100; ++i) {
      feature.z = Eigen::Vector2d(std::abs(uniform(random)) + 1.0, uniform(random) * 0.1);
      Initialization initialization;
      model.initialize(state, pose, feature, initialization);
      landmarks.push_back(state.augment(model.landmark_spec(), initialization));
      features.push_back(feature);
    }
    Ekf ekf(make_error_frame(frame));
    MotionStep motion;
    motion.target = pose;
    motion.cov_noise = 1e-4 * Eigen::Matrix3d::Identity();
    std::vector<LinearizedMeasurement> measurements(10);
    NoiseAdaptationParameters adaptation;
    adaptation.method = "residual";
    SageHusa noise(adaptation, {{"range", 0.1, 1e-3, 10.0, 0.0}, {"bearing", 0.1, 1e-3, 1.0, 0.0}},
                   {0.99, 0.99});
    ProcessScale process({}, 1.0);
    std::vector<Feature> seen;
    std::vector<Postfit> postfits;
    const auto step = [&](std::size_t k) {
      motion.estimate = state.estimate(pose);
      motion.wrt.clear();
      motion.wrt.add(pose, 3, 3).setIdentity();
      motion.cov_noise = 1e-4 * Eigen::Matrix3d::Identity();
      process.scale(motion.wrt.begin()->jacobian, motion.cov_noise);
      ekf.propagate(state, motion);
      seen.clear();
      for (std::size_t i = 0; i < measurements.size(); ++i)
        seen.push_back(features[(k * 7 + i) % features.size()]);
      noise.apply(seen);
      for (std::size_t i = 0; i < measurements.size(); ++i) {
        const std::size_t which = (k * 7 + i) % landmarks.size();
        model.linearize(state, pose, landmarks[which], seen[i], measurements[i]);
        ekf.innovate(state, measurements[i]);
      }
      for (bool again = true; again;) {
        if (!ekf.weigh(state, measurements)) return false;
        ekf.look_back(measurements, postfits);
        for (std::size_t i = 0; i < postfits.size(); ++i) postfits[i].feature = i;
        again = noise.observe(seen, postfits);
        for (std::size_t i = 0; i < postfits.size(); ++i) measurements[i].cov = seen[i].cov;
      }
      ekf.solve(state);
      ekf.apply(state, pose);
      process.observe(ekf.look_back(measurements, pose, state.size(pose)));
      return true;
    };
    ASSERT_TRUE(step(0));
    const long before = g_allocations.load();
    bool applied = true;
    for (std::size_t k = 1; k < 50; ++k) applied = step(k) && applied;
    const long after = g_allocations.load();
    EXPECT_TRUE(applied);
    EXPECT_EQ(after - before, 0) << frame;
    // The counter can fail: growing the state does allocate.
    state.reserve(4 * state.dimension());
    EXPECT_GT(g_allocations.load(), after);
  }
#endif
}

// Four walls of a room around a robot that turns: extraction, association and correction.
TEST(Allocation, AStepWithLinesIsFreeOfItInSteadyState) {
#if !LIBSLAM_COUNTS_MALLOC
  GTEST_SKIP() << "sanitizers own malloc";
#else
  constexpr double kStep = 0.01;
  GaussianState state;
  const BlockId pose = state.add({"pose", Chart::kSE2, 3, WorldRole::kPose},
                                 Eigen::Vector3d::Zero(), 1e-4 * Eigen::Matrix3d::Identity());
  const LineMeasurement model;
  LineExtraction extraction({});
  SequentialCompatibility associator(9.2, 25.0);
  Ekf ekf(make_error_frame("right_invariant"));
  Linearizer linearizer(nullptr);
  LandmarkRegistry registry(1, 0);
  SelectedPairs selected;
  std::vector<BeamPoint> points;
  std::vector<Feature> features;
  std::vector<Verdict> verdicts;
  std::vector<LinearizedMeasurement> measurements(4);
  const auto look = [&](double heading) {
    points.clear();
    for (double bearing = -3.1; bearing < 3.1; bearing += kStep) {
      const double angle = bearing + heading;
      const double range = 5.0 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
      points.push_back({range, bearing, {range * std::cos(bearing), range * std::sin(bearing)}});
    }
    features.clear();
    for (const ExtractedLine& line : extraction.extract(points, kStep)) {
      if (line.extent.length() < 3.0) continue;  // the wall behind is cut in two
      Feature& feature = features.emplace_back();
      feature.z = Eigen::Vector2d(line.alpha, line.r);
      feature.cov = line.cov;
      feature.extent = line.extent;
    }
  };
  features.reserve(8);
  look(0.0);
  for (const Feature& feature : features) {
    Initialization initialization;
    model.initialize(state, pose, feature, initialization);
    const BlockId block = state.augment(model.landmark_spec(), initialization);
    registry.add(block, kNoIdentity, nullptr, model.sighted_part(state, pose, block, feature));
  }
  ASSERT_GE(registry.size(), 3u);
  const auto step = [&](double heading) {
    look(heading);
    PairTest test({state, pose, ekf, linearizer, model, registry, selected, 0.6}, features);
    associator.associate(features, registry, test, verdicts);
    std::size_t paired = 0;
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (verdicts[i].outcome != Outcome::kPaired) continue;
      const BlockId block = registry.landmarks()[verdicts[i].landmark].block;
      model.linearize(state, pose, block, features[i], measurements[paired++]);
      registry.record_sighting(verdicts[i].landmark, nullptr,
                               model.sighted_part(state, pose, block, features[i]));
    }
    return paired > 0 && ekf.correct(state, pose, std::span(measurements).first(paired)).applied;
  };
  for (const double heading : {0.03, -0.03, 0.0}) ASSERT_TRUE(step(heading));
  const long before = g_allocations.load();
  bool applied = true;
  for (int k = 0; k < 50; ++k) applied = step(0.03 * std::sin(0.3 * k)) && applied;
  EXPECT_EQ(g_allocations.load() - before, 0);
  EXPECT_TRUE(applied);
#endif
}
