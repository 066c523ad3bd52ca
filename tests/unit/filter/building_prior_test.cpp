#include <numbers>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/filter/building_prior.hpp>
#include <libslam/state/chi_square.hpp>

using namespace libslam;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSigma = 3.0 * kPi / 180.0;

/// A building of walls with errors of `sigma` in direction and 5 cm in distance.
class Building {
 public:
  explicit Building(double sigma) : sigma_(sigma) {
    pose_ = state.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, Eigen::Vector3d(1, 2, 0.5),
                      1e-4 * Eigen::Matrix3d::Identity());
    prior.add_to(state);
  }
  BlockId add(double alpha, int sightings = 4, double length = 3.0) {
    const BlockId block =
        state.add({"", Chart::kLine, 2, WorldRole::kLine}, Eigen::Vector2d(alpha, 5.0),
                  Eigen::Vector2d(sigma_, 0.05).cwiseAbs2().asDiagonal().toDenseMatrix());
    registry.add(block, kNoIdentity, nullptr, Extent{0.0, length, 0.1, 0.1});
    while (--sightings > 0) registry.record_sighting(registry.size() - 1);
    return block;
  }
  void apply() { prior.apply(state, ekf_, pose_, registry); }
  double main_direction() const { return state.estimate(*state.find("wall_direction"))[0]; }

  GaussianState state;
  LandmarkRegistry registry{1, 0};
  BuildingPrior prior{{kSigma, 4, 1.2, chi_square_quantile(0.99, 1)}};

 private:
  Ekf ekf_{make_error_frame("right_invariant")};
  BlockId pose_;
  double sigma_;
};

/// Angle to the nearest right angle.
double off(double angle) {
  return std::remainder(angle, 0.5 * kPi);
}

}  // namespace

TEST(BuildingPrior, FindsTheMainDirectionAndPullsWallsTowardsIt) {
  Building building(0.05);
  const BlockId straight = building.add(0.3), across = building.add(0.3 + 0.5 * kPi),
                back = building.add(0.3 - kPi), astray = building.add(0.4);
  building.apply();
  EXPECT_EQ(building.prior.judged(), 4);
  EXPECT_EQ(building.prior.oblique(), 0);
  EXPECT_NEAR(off(building.main_direction() - 0.3), 0.0, 0.05);
  EXPECT_LT(off(building.state.estimate(astray)[0] - 0.3), 0.09);
  EXPECT_LT(building.state.covariance_of(astray)(0, 0), 0.05 * 0.05);
  for (const BlockId wall : {straight, across, back})
    EXPECT_NEAR(off(building.state.estimate(wall)[0] - 0.3), 0.0, 0.03);
}

TEST(BuildingPrior, LeavesAnObliqueWallAlone) {
  Building building(0.02);
  building.add(0.3);
  building.add(0.3 + 0.5 * kPi);
  building.apply();
  constexpr double kOblique = 0.3 + 0.35;
  const BlockId oblique = building.add(kOblique);
  const double direction = building.main_direction();
  building.apply();
  EXPECT_EQ(building.prior.judged(), 3);
  EXPECT_EQ(building.prior.oblique(), 1);
  EXPECT_EQ(building.state.estimate(oblique)[0], kOblique);
  EXPECT_EQ(building.state.covariance_of(oblique)(0, 0), 0.02 * 0.02);
  EXPECT_EQ(building.main_direction(), direction);
}

TEST(BuildingPrior, CountsEveryWallOnceAndOnlyTheSureOnes) {
  Building building(0.05);
  building.add(0.3, 3);
  building.add(0.3, 4, 1.1);
  building.apply();
  EXPECT_EQ(building.prior.judged(), 0);
  building.registry.record_sighting(0);
  building.apply();
  EXPECT_EQ(building.prior.judged(), 1);
  const double sigma2 = building.state.covariance_of(*building.state.find("wall_direction"))(0, 0);
  building.apply();
  EXPECT_EQ(building.prior.judged(), 1);
  EXPECT_EQ(building.state.covariance_of(*building.state.find("wall_direction"))(0, 0), sigma2);
}

// Walls that stray by the sigma of the prior: the errors of all walls together are chi-square, up
// to the one wall in a hundred that the gate takes for oblique.
TEST(BuildingPrior, IsAsGoodAsItSays) {
  constexpr int kRuns = 100, kWalls = 10;
  constexpr double kMeasured = 0.08;
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-kPi, kPi);
  double nees = 0.0, error2 = 0.0;
  int oblique = 0;
  for (int run = 0; run < kRuns; ++run) {
    Building building(kMeasured);
    const double main = uniform(random);
    std::vector<double> truth;
    std::vector<BlockId> walls;
    for (int i = 0; i < kWalls; ++i) {
      truth.push_back(main + 0.5 * kPi * (i % 4) + kSigma * normal(random));
      walls.push_back(building.add(wrap_angle(truth.back() + kMeasured * normal(random))));
    }
    building.apply();
    oblique += building.prior.oblique();
    Eigen::VectorXd error(kWalls);
    Eigen::MatrixXd cov(kWalls, kWalls);
    for (int i = 0; i < kWalls; ++i) {
      error[i] = wrap_angle(building.state.estimate(walls[i])[0] - truth[i]);
      for (int k = 0; k < kWalls; ++k)
        cov(i, k) = building.state.cross_covariance(walls[i], walls[k])(0, 0);
    }
    nees += error.dot(cov.ldlt().solve(error));
    error2 += error.squaredNorm();
  }
  EXPECT_LT(nees, chi_square_quantile(0.999, kRuns * kWalls));
  EXPECT_GT(nees, chi_square_quantile(0.001, kRuns * kWalls));
  EXPECT_LT(std::sqrt(error2 / (kRuns * kWalls)), 0.8 * kMeasured);  // and it does help
  EXPECT_LT(oblique, kRuns * kWalls / 25);
}

TEST(BuildingPrior, RefusesOptionsThatSayNothing) {
  EXPECT_THROW(BuildingPrior({0.0, 4, 1.0, 6.6}), std::invalid_argument);
  EXPECT_THROW(BuildingPrior({0.1, 4, 1.0, 0.0}), std::invalid_argument);
}
