#pragma once
// One frame to associate: landmarks of a map, a pose that is not well known, and what is seen.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Core>

#include <libslam/association/associator.hpp>
#include <libslam/data/feature.hpp>
#include <libslam/filter/ekf.hpp>
#include <libslam/filter/linearizer.hpp>
#include <libslam/filter/pair_test.hpp>
#include <libslam/measurement/range_bearing.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam::testing {

struct AssociationSceneOptions {
  int landmarks = 60;
  double area_per_landmark = 16.0;  ///< [m^2]; scattered over a square about the robot
  int observations = 9;             ///< of random landmarks in range
  int unmapped = 0;                 ///< further observations, of objects that are not in the map
  double max_range = 15.0;          ///< [m]
  double sigma_position = 0.3;      ///< of the pose [m]
  double sigma_heading = 3.0 * 3.14159265358979323846 / 180.0;
  double sigma_landmark = 0.05;  ///< of each coordinate in the map [m]
  double sigma_range = 0.05, sigma_bearing = 0.5 * 3.14159265358979323846 / 180.0;
};

/// The estimates are drawn from the covariance that the state claims: the filter is consistent.
class AssociationScene {
 public:
  static constexpr std::size_t kUnmapped = static_cast<std::size_t>(-1);

  AssociationScene(const AssociationSceneOptions& options, std::uint64_t seed)
      : random_(seed), ekf_(make_error_frame("standard")), linearizer_(nullptr) {
    const double half = 0.5 * std::sqrt(options.landmarks * options.area_per_landmark);
    std::uniform_real_distribution<double> place(-half, half);
    const Eigen::Vector3d sigma(options.sigma_position, options.sigma_position,
                                options.sigma_heading);
    pose_ = state_.add({"pose", Chart::kSE2, 3, WorldRole::kPose},
                       sigma.cwiseProduct(Eigen::Vector3d(normal(), normal(), normal())),
                       Eigen::MatrixXd(sigma.cwiseAbs2().asDiagonal()));
    std::vector<Eigen::Vector2d> truth;
    const double variance = options.sigma_landmark * options.sigma_landmark;
    for (int i = 0; i < options.landmarks; ++i) {
      truth.emplace_back(place(random_), place(random_));
      const Eigen::Vector2d error = options.sigma_landmark * Eigen::Vector2d(normal(), normal());
      registry.add(state_.add({"", Chart::kVector, 2, WorldRole::kPoint}, truth.back() + error,
                              variance * Eigen::Matrix2d::Identity()),
                   kNoIdentity);
    }
    std::vector<std::size_t> seen(truth.size());
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = i;
    std::shuffle(seen.begin(), seen.end(), random_);
    std::erase_if(seen, [&](std::size_t i) { return truth[i].norm() > options.max_range; });
    seen.resize(std::min(seen.size(), static_cast<std::size_t>(options.observations)));
    for (const std::size_t i : seen) observe(truth[i], i, options);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < options.unmapped;) {
      const Eigen::Vector2d object =
          options.max_range * Eigen::Vector2d(unit(random_), unit(random_));
      if (object.norm() > options.max_range) continue;
      observe(object, kUnmapped, options);
      ++i;
    }
  }

  PairTest test() {
    return PairTest({state_, pose_, ekf_, linearizer_, model_, registry, selected_, 0.0}, features);
  }
  /// Innovations of all landmarks as MRPT wants them: predictions and their joint covariance, of
  /// the observation noise too.
  void predict(Eigen::MatrixXd& mean, Eigen::MatrixXd& cov) {
    PairTest all = test();
    std::vector<Pairing> pairs;
    for (std::size_t k = 0; k < registry.size(); ++k) pairs.push_back({0, k});
    all.select(pairs);
    const auto n = static_cast<Eigen::Index>(pairs.size());
    mean.resize(n, 2);
    cov.resize(2 * n, 2 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto first = static_cast<std::size_t>(i);
      mean.row(i) = (features[0].z - all.innovation(first)).transpose();
      for (Eigen::Index k = 0; k < n; ++k)
        cov.block<2, 2>(2 * i, 2 * k) = all.covariance(first, static_cast<std::size_t>(k));
    }
  }

  std::vector<Feature> features;
  std::vector<std::size_t> partners;  ///< true landmark of each feature, or kUnmapped
  LandmarkRegistry registry{1, 0};

 private:
  double normal() { return std::normal_distribution<double>()(random_); }
  void observe(const Eigen::Vector2d& p, std::size_t partner,
               const AssociationSceneOptions& options) {
    Feature& feature = features.emplace_back();
    const Eigen::Vector2d sigma(options.sigma_range, options.sigma_bearing);
    feature.z = Eigen::Vector2d(p.norm() + sigma[0] * normal(),
                                wrap_angle(std::atan2(p.y(), p.x()) + sigma[1] * normal()));
    feature.cov = sigma.cwiseAbs2().asDiagonal();
    partners.push_back(partner);
  }

  std::mt19937_64 random_;
  GaussianState state_;
  BlockId pose_;
  Ekf ekf_;
  Linearizer linearizer_;
  RangeBearing model_;
  SelectedPairs selected_;
};

}  // namespace libslam::testing
