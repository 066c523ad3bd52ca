#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>

#include <libslam/policy/disturbance.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {

namespace {

/// No evidence is within every level, a distance that is no number within none.
bool within(double nis, int dof, double probability) {
  return dof == 0 || (std::isfinite(nis) && chi_square_probability(nis, dof) <= probability);
}

}  // namespace

Disturbance::Disturbance(DisturbanceOptions options) : options_(std::move(options)) {
  const auto probability = [](double p) { return p > 0.0 && p < 1.0; };
  if (options_.window < 1 || options_.hold < 1)
    throw std::invalid_argument("a disturbance needs a window and a hold of at least one update");
  if (!probability(options_.trigger_probability) || !probability(options_.release_probability))
    throw std::invalid_argument("trigger and release of a disturbance are probabilities in (0, 1)");
  if (!(options_.sigma.size() > 0 && options_.sigma.minCoeff() > 0.0))
    throw std::invalid_argument("the displacement of a disturbance needs positive sigmas");
}

bool Disturbance::possible(double nis, int dof) const {
  return within(nis, dof, options_.trigger_probability);
}

bool Disturbance::quiet(double nis, int dof) const {
  return within(nis, dof, options_.release_probability);
}

bool Disturbance::judge(double nis, int dof, bool estranged) {
  recent_.push_back({nis, dof});
  if (recent_.size() > static_cast<std::size_t>(options_.window)) recent_.pop_front();
  Sum all;
  for (const Sum& one : recent_) {
    all.nis += one.nis;
    all.dof += one.dof;
  }
  const bool triggered = estranged || !possible(nis, dof) || !possible(all.nis, all.dof);
  began_ = triggered && !lasts_;
  lasts_ = lasts_ || triggered;
  if (!lasts_) return false;
  if (triggered || !quiet(nis, dof)) {
    // What was inflated explains the past.
    recent_.clear();
    quiet_ = blind_ = 0;
    return true;
  }
  // No evidence is no quiet update. But a robot that has left its map would never map again.
  if (dof > 0)
    ++quiet_;
  else
    ++blind_;
  if (quiet_ >= options_.hold || blind_ >= kBlindHolds * options_.hold) settle();
  return false;
}

void Disturbance::begin() {
  recent_.clear();
  began_ = began_ || !lasts_;
  lasts_ = true;
  quiet_ = blind_ = 0;
}

void Disturbance::settle() {
  recent_.clear();
  lasts_ = began_ = false;
  quiet_ = blind_ = 0;
}

double Disturbance::squared_distance(const JointInnovation& joint) {
  const Eigen::LLT<Eigen::MatrixXd> s(joint.cov);
  if (s.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return s.matrixL().solve(joint.nu).squaredNorm();
}

double Disturbance::scale(const JointInnovation& joint) const {
  if (options_.inflation == Inflation::kAdditive) return 1.0;
  const Eigen::LLT<Eigen::MatrixXd> s(joint.cov);
  if (s.info() != Eigen::Success) return 0.0;
  const Eigen::VectorXd w = s.matrixL().solve(joint.nu);
  const Eigen::MatrixXd g = s.matrixL().solve(joint.wrt_pose * options_.sigma.asDiagonal());
  const BlockMatrix a = g.transpose() * g;
  const TangentVector b = g.transpose() * w;
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  for (const double scale : kScales) {
    const double s2 = scale * scale;
    const Eigen::LLT<BlockMatrix> m(BlockMatrix::Identity(a.rows(), a.cols()) + s2 * a);
    const double log_det = 2.0 * m.matrixLLT().diagonal().array().log().sum();
    const double cost = log_det - s2 * b.dot(m.solve(b));
    if (cost < least) {
      least = cost;
      best = scale;
    }
  }
  return best;
}

BlockMatrix Disturbance::added(double scale) const {
  return BlockMatrix((scale * options_.sigma).cwiseAbs2().asDiagonal());
}

double Disturbance::factor(const JointInnovation& joint) const {
  const double predicted = joint.cov.trace() - joint.trace_noise;
  const double excess = joint.nu.squaredNorm() - joint.trace_noise;
  if (!(predicted > 0.0)) return options_.max_factor;
  return std::clamp(excess / predicted, 1.0, options_.max_factor);
}

}  // namespace libslam
