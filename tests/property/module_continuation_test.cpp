// A module that is saved, loaded into a new one and goes on is the module that was not saved.

#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>
#include <rapidcheck/gtest.h>

#include <libslam/modules/range_bearing_slam_2d.hpp>
#include <libslam/modules/slam_map_builder.hpp>

#include "support/mrpt_pair.hpp"
#include "support/slam_world.hpp"

using namespace libslam;
using libslam::testing::SlamWorld;

namespace {

constexpr int kSteps = 60;

struct Pair {
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr frame;
};

std::vector<Pair> drive(std::uint64_t seed, bool known) {
  std::mt19937_64 random(seed);
  SlamWorld world;
  std::vector<Pair> log;
  for (int k = 0; k < kSteps; ++k) {
    const double time = 100.0 + 0.1 * k;
    const auto action = libslam::testing::make_action(world.drive(random, 1.0), time);
    std::vector<Feature> features = world.observe(random, 1.0);
    if (!known)
      for (Feature& feature : features) feature.id = kNoIdentity;
    log.push_back({action, libslam::testing::make_frame(features, world.T_robot_sensor, time)});
  }
  return log;
}

void configure(Parameters& p) {
  p.motion.model = "differential";
  p.motion.noise.from_log = false;
  // Grows with time: the clock must go on as well.
  p.motion.noise.along_per_sqrt_s = 0.01;
  p.calibration.scale_left.enabled = p.calibration.scale_right.enabled = true;
  p.calibration.scale_left.random_walk_per_sqrt_s = 1e-4;
}

template <typename Module>
void save_and_load(const Module& from, Module& to) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  from.saveState(archive);
  stream.Seek(0);
  to.loadState(archive);
}

std::string state_of(const auto& module) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  module.saveState(archive);
  return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
}

}  // namespace

RC_GTEST_PROP(ModuleContinuation, OfTheRangeBearingFilter, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(1, 1000000);
  const bool known = *rc::gen::arbitrary<bool>();
  const int cut = *rc::gen::inRange(1, kSteps - 1);
  auto log = drive(seed, known);

  RangeBearingSlam2D whole, first, second;
  for (RangeBearingSlam2D* slam : {&whole, &first, &second}) configure(slam->options.parameters);
  for (Pair& pair : log) whole.processActionObservation(pair.action, pair.frame);
  for (int k = 0; k < cut; ++k)
    first.processActionObservation(log[static_cast<std::size_t>(k)].action,
                                   log[static_cast<std::size_t>(k)].frame);
  save_and_load(first, second);
  for (int k = cut; k < kSteps; ++k)
    second.processActionObservation(log[static_cast<std::size_t>(k)].action,
                                    log[static_cast<std::size_t>(k)].frame);
  RC_ASSERT(state_of(second) == state_of(whole));
}

RC_GTEST_PROP(ModuleContinuation, OfTheMapBuilder, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(1, 1000000);
  const bool known = *rc::gen::arbitrary<bool>();
  const int cut = *rc::gen::inRange(1, kSteps - 1);
  auto log = drive(seed, known);

  SlamMapBuilder whole, first, second;
  for (SlamMapBuilder* builder : {&whole, &first, &second}) {
    Parameters& p = builder->slam_options.parameters;
    configure(p);
    p.association.method = known ? "known" : "nearest_neighbour";
    builder->initialize();
  }
  for (Pair& pair : log) whole.processActionObservation(*pair.action, *pair.frame);
  for (int k = 0; k < cut; ++k)
    first.processActionObservation(*log[static_cast<std::size_t>(k)].action,
                                   *log[static_cast<std::size_t>(k)].frame);
  save_and_load(first, second);
  for (int k = cut; k < kSteps; ++k)
    second.processActionObservation(*log[static_cast<std::size_t>(k)].action,
                                    *log[static_cast<std::size_t>(k)].frame);
  RC_ASSERT(state_of(second) == state_of(whole));
  RC_ASSERT(second.getCurrentlyBuiltMapSize() == whole.getCurrentlyBuiltMapSize());
}
