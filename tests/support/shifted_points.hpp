#pragma once
// The smallest problem of joint association: points seen with one common, unknown shift.

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>

#include <libslam/association/associator.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam::testing {

/// Points that are all shifted by one unknown error: z_i = m_k + shift + noise.
class ShiftedPoints final : public Compatibility {
 public:
  ShiftedPoints(std::vector<Eigen::Vector2d> seen, std::vector<Eigen::Vector2d> map,
                double sigma_shift, double sigma_noise)
      : seen_(std::move(seen)), map_(std::move(map)) {
    shift_ = sigma_shift * sigma_shift * Eigen::Matrix2d::Identity();
    noise_ = sigma_noise * sigma_noise * Eigen::Matrix2d::Identity();
  }

  std::optional<Match> test(std::size_t feature, std::size_t landmark, double) override {
    const Eigen::Vector2d nu = seen_[feature] - map_[landmark];
    const Eigen::Matrix2d s = covariance(0, 0);
    return Match{nu.dot(s.inverse() * nu), std::log(s.determinant())};
  }
  void select(std::span<const Pairing> pairs) override {
    nu_.clear();
    for (const auto& [feature, landmark] : pairs) nu_.emplace_back(seen_[feature] - map_[landmark]);
  }
  const MeasurementVector& innovation(std::size_t pair) const override { return nu_[pair]; }
  const MeasurementMatrix& noise(std::size_t) const override { return noise_; }
  MeasurementMatrix covariance(std::size_t first, std::size_t second) const override {
    MeasurementMatrix sum = shift_;
    if (first == second) sum += noise_;
    return sum;
  }

  std::size_t features() const { return seen_.size(); }
  std::size_t landmarks() const { return map_.size(); }
  LandmarkRegistry registry() const {
    LandmarkRegistry registry(1, 0);
    for (std::size_t k = 0; k < map_.size(); ++k)
      registry.add(BlockId{static_cast<int>(k)}, kNoIdentity);
    return registry;
  }
  /// d^2 and log|S| from the whole matrix.
  Match joint(const std::vector<Pairing>& pairs) {
    select(pairs);
    const auto rows = static_cast<Eigen::Index>(2 * pairs.size());
    Eigen::MatrixXd s(rows, rows);
    Eigen::VectorXd nu(rows);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      nu.segment<2>(static_cast<Eigen::Index>(2 * i)) = innovation(i);
      for (std::size_t k = 0; k < pairs.size(); ++k)
        s.block<2, 2>(static_cast<Eigen::Index>(2 * i), static_cast<Eigen::Index>(2 * k)) =
            covariance(i, k);
    }
    return {nu.dot(s.ldlt().solve(nu)), std::log(s.determinant())};
  }
  bool compatible(const std::vector<Pairing>& pairs, double probability) {
    return joint(pairs).mahalanobis2 <=
           chi_square_quantile(probability, 2 * static_cast<int>(pairs.size()));
  }

 private:
  std::vector<Eigen::Vector2d> seen_, map_;
  MeasurementMatrix shift_, noise_;
  std::vector<MeasurementVector> nu_;
};

}  // namespace libslam::testing
