// A run that is cut, saved, loaded and continued is the run that was not cut.

#include <limits>
#include <tests/support/slam_world.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/association/nearest_neighbour.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/io/map_encoding.hpp>
#include <libslam/measurement/range_bearing.hpp>
#include <libslam/motion/differential.hpp>

using namespace libslam;
using libslam::testing::SlamWorld;

namespace {

constexpr int kSteps = 160;

/// Provisional landmarks, calibration and its excitation: all that a filter remembers.
EkfSlamParts make_parts(bool known, const char* frame) {
  MotionParameters motion;
  motion.track_width = 0.5;
  motion.noise.from_log = false;
  CalibrationParameters calibration;
  calibration.scale_left.enabled = calibration.scale_right.enabled = true;
  EkfSlamParts parts;
  parts.motion = std::make_unique<Differential>(motion, calibration);
  parts.measurement = std::make_unique<RangeBearing>();
  if (known)
    parts.associator = std::make_unique<KnownAssociation>(11.8);
  else
    parts.associator = std::make_unique<NearestNeighbour>(11.8, 40.0);
  parts.frame = make_error_frame(frame);
  parts.registry = LandmarkRegistry(3, 20);
  return parts;
}

struct LogOfWorld {
  std::vector<MotionAction> actions;
  std::vector<std::vector<Feature>> frames;
};

LogOfWorld drive(std::uint64_t seed, bool known) {
  LogOfWorld log;
  std::mt19937_64 random(seed);
  SlamWorld world;
  for (int k = 0; k < kSteps; ++k) {
    log.actions.push_back(world.drive(random, 1.0));
    log.frames.push_back(world.observe(random, 1.0));
    if (!known)
      for (Feature& feature : log.frames.back()) feature.id = kNoIdentity;
  }
  return log;
}

void run(EkfSlam& filter, const LogOfWorld& log, int from, int to) {
  for (int k = from; k < to; ++k) {
    filter.propagate(&log.actions[static_cast<std::size_t>(k)]);
    filter.update(log.frames[static_cast<std::size_t>(k)]);
  }
}

}  // namespace

// Every operation is the same on the same numbers, whether they were in a file in between: the
// tolerance is rounding at most, and the maps at the end are the same bytes.
RC_GTEST_PROP(MapContinuation, ACutRunIsTheWholeRun, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(1, 1000000);
  const bool known = *rc::gen::arbitrary<bool>();
  const char* const frame = *rc::gen::element("standard", "right_invariant");
  const int cut = *rc::gen::inRange(1, kSteps - 1);
  const LogOfWorld log = drive(seed, known);

  EkfSlam whole(make_parts(known, frame));
  run(whole, log, 0, kSteps);
  EkfSlam first(make_parts(known, frame));
  run(first, log, 0, cut);
  EkfSlamParts parts = make_parts(known, frame);
  const std::string bytes = encode_map(first.saved_map());
  parts.map.emplace().map = std::make_shared<SavedMap>(decode_map(bytes, "saved"));
  EkfSlam second(std::move(parts));
  RC_ASSERT(encode_map(second.saved_map()) == bytes);
  run(second, log, cut, kSteps);

  RC_ASSERT(second.state().dimension() == whole.state().dimension());
  const double error =
      (second.state().estimate(second.pose()) - whole.state().estimate(whole.pose())).norm();
  RC_ASSERT(error < 1e-12);
  RC_ASSERT((second.state().full_covariance() - whole.state().full_covariance()).norm() < 1e-12);
  RC_ASSERT(encode_map(second.saved_map()) == encode_map(whole.saved_map()));
}
