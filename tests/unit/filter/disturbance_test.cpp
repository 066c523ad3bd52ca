#include <limits>
#include <string>
#include <tests/support/slam_world.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/association/nearest_neighbour.hpp>
#include <libslam/data/step_events.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/measurement/range_bearing.hpp>
#include <libslam/motion/odometry_increment.hpp>
#include <libslam/state/chi_square.hpp>

using namespace libslam;
using libslam::testing::SlamWorld;

namespace {

/// Counts what it is shown.
class CountingNoise final : public NoisePolicy {
 public:
  explicit CountingNoise(int& observed) : observed_(observed) {}
  void apply(std::span<Feature>) override {}
  bool observe(std::span<Feature>, std::span<const Postfit>) override {
    ++observed_;
    return false;
  }
  std::vector<AdaptedNoise> noise() const override { return {}; }

 private:
  int& observed_;
};

struct FilterSetup {
  bool known = true;
  std::optional<Inflation> inflation = Inflation::kMaximumLikelihood;
  bool relocalize = true;
  const char* frame = "right_invariant";
};

EkfSlamParts parts_with(const FilterSetup& setup) {
  EkfSlamParts parts;
  parts.motion = std::make_unique<OdometryIncrement>(MotionParameters{}, CalibrationParameters{});
  parts.measurement = std::make_unique<RangeBearing>();
  const double gate = chi_square_quantile(0.99, 2);
  if (setup.known)
    parts.associator = std::make_unique<KnownAssociation>(gate);
  else
    parts.associator = std::make_unique<NearestNeighbour>(gate, chi_square_quantile(0.99999, 2));
  parts.frame = make_error_frame(setup.frame);
  if (setup.inflation) {
    DisturbanceOptions options;
    options.inflation = *setup.inflation;
    options.sigma = Eigen::Vector3d(1.0, 1.0, 0.2);
    ResponseOptions response;
    response.near_landmark = 4.0;
    response.relocalize = setup.relocalize;
    parts.disturbance.emplace(Disturbance(options), response);
  }
  return parts;
}

/// A world without symmetry, so that constellations are unique.
SlamWorld scattered_world(std::mt19937_64& random) {
  SlamWorld world(8, 4.0);
  world.T_robot_sensor.setZero();
  std::uniform_real_distribution<double> shift(-1.2, 1.2);
  for (auto& landmark : world.landmarks) landmark += Eigen::Vector2d(shift(random), shift(random));
  return world;
}

/// A drive on a circle; features without identity if asked for.
class Drive {
 public:
  Drive(const FilterSetup& setup, std::uint64_t seed)
      : random(seed),
        world(scattered_world(random)),
        filter(parts_with(setup)),
        known(setup.known) {}

  UpdateOutcome step() {
    const MotionAction action = world.drive(random, 1.0);
    filter.propagate(&action);
    std::vector<Feature> features = world.observe(random, 1.0);
    if (!known)
      for (Feature& feature : features) feature.id = kNoIdentity;
    return filter.update(features);
  }
  void steps(int n) {
    for (int k = 0; k < n; ++k) step();
  }
  /// Displacement in the robot frame.
  void kidnap(double forward, double left, double turn) {
    const Eigen::Rotation2Dd R(world.pose[2]);
    world.pose.head<2>() += R * Eigen::Vector2d(forward, left);
    world.pose[2] = wrap_angle(world.pose[2] + turn);
  }
  Eigen::Vector3d error() const {
    Eigen::Vector3d e = filter.state().estimate(filter.pose()) - world.pose;
    e[2] = wrap_angle(e[2]);
    return e;
  }
  double nees() const {
    const Eigen::Matrix3d cov = filter.state().covariance_of(filter.pose());
    return error().dot(cov.ldlt().solve(error()));
  }
  double map_rmse() const {
    double sum = 0.0;
    const auto map = filter.landmarks();
    for (const auto& landmark : map) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& truth : world.landmarks)
        nearest = std::min(nearest, (landmark.mean - truth).squaredNorm());
      sum += nearest;
    }
    return std::sqrt(sum / static_cast<double>(map.size()));
  }

  std::mt19937_64 random;
  SlamWorld world;
  EkfSlam filter;
  bool known;
};

constexpr int kLap = 126;  // steps of .05 rad

}  // namespace

TEST(DisturbanceResponse, ChangesNothingWhileNothingHappens) {
  for (const bool known : {true, false}) {
    Drive with({known}, 7), without({known, std::nullopt}, 7);
    for (int k = 0; k < 2 * kLap; ++k) {
      EXPECT_EQ(with.step().event, "");
      without.step();
    }
    EXPECT_EQ(with.filter.state().full_covariance(), without.filter.state().full_covariance());
    for (std::size_t i = 0; i < with.filter.registry().size(); ++i) {
      const BlockId block = with.filter.registry().landmarks()[i].block;
      EXPECT_EQ(Eigen::VectorXd(with.filter.state().estimate(block)),
                Eigen::VectorXd(without.filter.state().estimate(block)));
    }
  }
}

// Wide enough gates let the landmarks in that the recovery needs; without a response the gate
// keeps all of them out.
TEST(DisturbanceResponse, FindsBackWithTheLandmarksThatTheGateRejected) {
  for (const char* frame : {"standard", "right_invariant"}) {
    Drive with({true, Inflation::kMaximumLikelihood, true, frame}, 8);
    Drive without({true, std::nullopt, true, frame}, 8);
    with.steps(kLap);
    without.steps(kLap);
    const double map_before = with.map_rmse();
    with.kidnap(1.5, 0.5, 0.3);
    without.kidnap(1.5, 0.5, 0.3);
    const UpdateOutcome first = with.step();
    EXPECT_TRUE(has_event(first.event, "disturbance"));
    EXPECT_GT(first.accepted, 3);
    EXPECT_EQ(without.step().accepted, 0);
    with.steps(4);
    without.steps(4);
    EXPECT_LT(with.error().head<2>().norm(), 0.15) << frame;
    EXPECT_GT(without.error().head<2>().norm(), 1.0) << frame;
    with.steps(kLap);
    if (frame == std::string("right_invariant")) {
      EXPECT_LT(with.map_rmse(), 1.3 * map_before + 0.01);
    }
  }
}

TEST(DisturbanceResponse, TheWholeStateMovesTheMap) {
  const auto moved = [](Inflation inflation) {
    Drive drive({true, inflation, false}, 9);
    drive.steps(2 * kLap);
    const auto before = drive.filter.landmarks();
    drive.kidnap(1.5, 0.0, 0.3);
    drive.steps(3);
    const auto after = drive.filter.landmarks();
    double sum = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i)
      sum += (after[i].mean - before[i].mean).squaredNorm();
    return std::sqrt(sum / static_cast<double>(before.size()));
  };
  EXPECT_GT(moved(Inflation::kWholeState), 5.0 * moved(Inflation::kMaximumLikelihood));
  EXPECT_LT(moved(Inflation::kAdditive), 0.05);
}

TEST(DisturbanceResponse, NothingLearnsAndNoLandmarkIsAddedWhileItLasts) {
  FilterSetup setup;
  int observed = 0;
  EkfSlamParts parts = parts_with(setup);
  parts.noise = std::make_unique<CountingNoise>(observed);
  Drive drive(setup, 10);
  drive.filter = EkfSlam(std::move(parts));
  drive.steps(kLap / 2);
  EXPECT_EQ(observed, kLap / 2 - 1);  // the first update has no pairs
  drive.kidnap(1.0, 0.0, 0.1);
  // A landmark that nobody has seen, in view from now on.
  drive.world.landmarks.push_back(drive.world.pose.head<2>() + Eigen::Vector2d(1.0, 1.0));
  const std::int64_t fresh = static_cast<std::int64_t>(drive.world.landmarks.size()) - 1;
  const int before = observed;
  EXPECT_TRUE(has_event(drive.step().event, "disturbance"));
  for (int k = 0; k < 3; ++k) EXPECT_EQ(drive.step().new_landmarks, 0);
  EXPECT_EQ(observed, before);
  EXPECT_FALSE(drive.filter.registry().find(fresh));
  drive.steps(20);
  EXPECT_TRUE(drive.filter.registry().find(fresh));
  EXPECT_GT(observed, before);
}

// Without identities the displacement that explains most of the frame is looked for.
TEST(DisturbanceResponse, FindsBackWithoutIdentities) {
  for (int seed = 20; seed < 30; ++seed) {
    Drive drive({false}, static_cast<std::uint64_t>(seed));
    drive.steps(2 * kLap);
    const std::size_t landmarks = drive.filter.registry().size();
    drive.kidnap(1.0, 0.5, 0.25);
    drive.steps(15);
    EXPECT_LT(drive.error().head<2>().norm(), 0.2) << seed;
    EXPECT_LE(drive.filter.registry().size(), landmarks + 1) << seed;
  }
}

// Anywhere in the mapped world: lost, then found by the constellation (or the identities), with a
// covariance that tells the truth: 40 runs, NEES of 3 degrees of freedom averages 3, sd .39.
TEST(DisturbanceResponse, FindsALostRobotAnywhereInItsMap) {
  for (const bool known : {false, true}) {
    double nees = 0.0;
    int found = 0, runs = 0;
    for (int seed = 40; seed < 60; ++seed) {
      Drive drive({known}, static_cast<std::uint64_t>(seed));
      drive.steps(2 * kLap);
      std::uniform_real_distribution<double> turn(-3.1, 3.1);
      drive.kidnap(0.0, 12.0, turn(drive.random));
      ++runs;
      int relocalized = 0;
      for (int k = 0; k < 20 && relocalized == 0; ++k)
        if (has_event(drive.step().event, "relocalized")) relocalized = k + 1;
      if (relocalized == 0 && drive.error().head<2>().norm() > 1.0) continue;
      ++found;
      EXPECT_LT(drive.error().head<2>().norm(), 1.0) << seed << " " << known;
      nees += drive.nees();
    }
    EXPECT_GE(found, runs - 1) << known;
    EXPECT_LT(nees / found, 3.0 + 3 * 0.55) << known;
    EXPECT_GT(nees / found, 3.0 - 3 * 0.55) << known;
  }
}

TEST(DisturbanceResponse, TellsAllThatHappensInOneUpdate) {
  UpdateOutcome all, one;
  for (const char* event : {"disturbance", "lost+relocalized", "", "disturbance"}) {
    one.event = event;
    all += one;
  }
  EXPECT_EQ(all.event, "disturbance+lost+relocalized");
  EXPECT_TRUE(has_event(all.event, "lost"));
  EXPECT_FALSE(has_event(all.event, "los"));
  // With identities a kidnap is noticed and undone by the same update.
  Drive drive({true}, 44);
  drive.steps(2 * kLap);
  drive.kidnap(0.0, 12.0, 2.0);
  std::string events;
  for (int k = 0; k < 5; ++k) add_events(events, drive.step().event);
  EXPECT_TRUE(has_event(events, "disturbance")) << events;
}

TEST(DisturbanceResponse, AFilterThatLostItsPoseStartsAnywhere) {
  Drive drive({false}, 71);
  drive.steps(2 * kLap);
  drive.kidnap(0.0, 12.0, 2.0);
  drive.filter.lose_pose();
  EXPECT_EQ(drive.step().event, "relocalized");
  EXPECT_LT(drive.error().head<2>().norm(), 0.5);
}

TEST(DisturbanceResponse, TheSameDriveGivesTheSameBits) {
  Drive a({false}, 72), b({false}, 72);
  for (Drive* drive : {&a, &b}) {
    drive->steps(kLap);
    drive->kidnap(0.0, 12.0, 1.0);
    drive->steps(30);
  }
  EXPECT_EQ(a.filter.state().full_covariance(), b.filter.state().full_covariance());
}
