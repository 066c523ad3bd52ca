#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>

#include <libslam/frontend/stereo_motion.hpp>

namespace libslam {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// 99.9 % to meet a clean triple with half of the pairs wrong: log(1e-3) / log(1 - 0.5^3) = 52.
constexpr int kTriples = 128;
constexpr int kIterations = 8;
constexpr int kRounds = 4;
constexpr int kPolishing = 4;
constexpr double kConverged = 1e-9;
constexpr double kNearest = 1e-3;  ///< depth [m]

/// What a pair says about the motion at some estimate.
struct Residual {
  Eigen::Vector3d e;
  Eigen::Matrix3d J;  ///< d h / d (T p)
  Eigen::Vector3d p_after;
  Eigen::Matrix3d information;
};

bool linearize(const StereoCamera& camera, const Eigen::Isometry3d& T, const SightingPair& pair,
               Residual& out) {
  out.p_after = T * pair.p_before;
  if (out.p_after.z() < kNearest) return false;
  out.e = pair.z_after - project(camera, out.p_after);
  out.J = projection_jacobian(camera, out.p_after);
  const Eigen::Matrix3d G = out.J * T.linear();
  out.information = (pair.cov_after + G * pair.cov_before * G.transpose()).inverse();
  return true;
}

int count_support(const StereoCamera& camera, std::span<const SightingPair> pairs,
                  const Eigen::Isometry3d& T, double gate, std::vector<bool>& agrees) {
  agrees.assign(pairs.size(), false);
  int support = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    agrees[i] = disagreement(camera, T, pairs[i]) <= gate;
    support += agrees[i] ? 1 : 0;
  }
  return support;
}

/// Moves T to the minimum over the pairs that agree; returns the covariance of the motion.
Matrix6 minimize(const StereoCamera& camera, std::span<const SightingPair> pairs,
                 const std::vector<bool>& agrees, Eigen::Isometry3d& T,
                 int iterations = kIterations) {
  Matrix6 H;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    H.setZero();
    Vector6 g = Vector6::Zero();
    Residual r;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (!agrees[i] || !linearize(camera, T, pairs[i], r)) continue;
      Eigen::Matrix<double, 3, 6> A;  // d h / d (translation, rotation) applied from the left
      A << r.J, -r.J.rowwise().cross(r.p_after.transpose());  // -J [p]: rows j^T [p] = (j x p)^T
      H += A.transpose() * r.information * A;
      g += A.transpose() * r.information * r.e;
    }
    const Vector6 step = H.ldlt().solve(g);
    if (!step.allFinite()) break;
    const Eigen::Vector3d w = step.tail<3>();
    const double angle = w.norm();
    const Eigen::AngleAxisd turn(
        angle, angle > 0.0 ? Eigen::Vector3d(w / angle) : Eigen::Vector3d::UnitX());
    T = Eigen::Translation3d(step.head<3>()) * turn * T;
    if (step.norm() < kConverged) break;
  }
  return H.inverse();
}

/// Absolute orientation of a triple, then a few steps to what its pixels say: depths are far
/// noisier than directions.
Eigen::Isometry3d orient(const StereoCamera& camera, std::span<const SightingPair> pairs,
                         const std::array<std::size_t, 3>& triple) {
  Eigen::Matrix3d before, after;
  std::array<SightingPair, 3> chosen;
  for (int k = 0; k < 3; ++k) {
    const SightingPair& pair = chosen[static_cast<std::size_t>(k)] =
        pairs[triple[static_cast<std::size_t>(k)]];
    before.col(k) = pair.p_before;
    after.col(k) = triangulate(camera, pair.z_after);
  }
  Eigen::Isometry3d T;
  T.matrix() = Eigen::umeyama(before, after, false);
  minimize(camera, chosen, {true, true, true}, T, kPolishing);
  return T;
}

}  // namespace

double disagreement(const StereoCamera& camera, const Eigen::Isometry3d& T_after_before,
                    const SightingPair& pair) {
  Residual r;
  if (!linearize(camera, T_after_before, pair, r)) return std::numeric_limits<double>::infinity();
  return r.e.dot(r.information * r.e);
}

void locate(const StereoCamera& camera, const StereoMatch& point, Eigen::Vector3d& p,
            Eigen::Matrix3d& cov) {
  p = triangulate(camera, point.z);
  const Eigen::Matrix3d G = triangulation_jacobian(camera, p, point.z[2]);
  cov = G * covariance_of(point) * G.transpose();
}

std::optional<StereoMotion> estimate_stereo_motion(const StereoCamera& camera,
                                                   std::span<const SightingPair> pairs,
                                                   const Eigen::Isometry3d& first_guess,
                                                   double gate, int least_support) {
  if (pairs.size() < static_cast<std::size_t>(std::max(least_support, 3))) return std::nullopt;
  StereoMotion best;
  best.T_after_before = first_guess;
  best.support = count_support(camera, pairs, first_guess, gate, best.agrees);
  std::mt19937_64 random(0x5eed);
  std::vector<bool> agrees;
  for (int i = 0; i < kTriples; ++i) {
    std::array<std::size_t, 3> triple{};
    for (std::size_t& k : triple) k = random() % pairs.size();
    if (triple[0] == triple[1] || triple[1] == triple[2] || triple[0] == triple[2]) continue;
    const Eigen::Isometry3d T = orient(camera, pairs, triple);
    if (!T.matrix().allFinite()) continue;
    const int support = count_support(camera, pairs, T, gate, agrees);
    if (support <= best.support) continue;
    best.T_after_before = T;
    best.support = support;
    best.agrees = agrees;
  }
  for (int round = 0; round < kRounds && best.support >= least_support; ++round) {
    best.cov = minimize(camera, pairs, best.agrees, best.T_after_before);
    const int before = best.support;
    best.support = count_support(camera, pairs, best.T_after_before, gate, best.agrees);
    if (best.support == before && round > 0) break;
  }
  if (best.support < least_support || !best.cov.allFinite()) return std::nullopt;
  return best;
}

}  // namespace libslam
