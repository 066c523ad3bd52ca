#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <libslam/policy/sage_husa.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {

namespace {

using Eigen::Index;

/// Errors that always have the same ratio make R singular but for rounding, which then decides on
/// its sign: so much of every error is taken to be its own.
constexpr double kIndependence = 1e-3;

/// Relative change of a variance that is worth weighing an observation again: in steady state none
/// is, at the start and after a step it takes a few rounds.
constexpr double kWorthAnotherRound = 0.1;
constexpr int kMostRounds = 5;

double distance_of(const Feature& feature) {
  if (!feature.camera) return feature.z[0];
  // A disparity that noise made tiny or negative: as far as the camera can tell, one pixel.
  return feature.camera->fx * feature.camera->baseline / std::max(feature.z[2], 1.0);
}

/// M <- L^-1 M, L lower triangular; so small that a general solver would cost several times more.
template <class Matrix>
void divide(const MeasurementMatrix& lower, Matrix&& m) {
  for (Index c = 0; c < m.cols(); ++c)
    for (Index r = 0; r < m.rows(); ++r) {
      for (Index k = 0; k < r; ++k) m(r, c) -= lower(r, k) * m(k, c);
      m(r, c) /= lower(r, r);
    }
}

/// sum += x x^T / kappa - expected; plain loops for the same reason.
void add_square(const MeasurementVector& x, double kappa, const MeasurementMatrix& expected,
                MeasurementMatrix& sum) {
  for (Index c = 0; c < x.size(); ++c) {
    const double scaled = x[c] / kappa;
    for (Index r = 0; r < x.size(); ++r) sum(r, c) += x[r] * scaled - expected(r, c);
  }
}

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("noise adaptation: " + what);
}

/// What it takes is not built unless it fails: this runs for every feature.
void require(bool holds, const char* what) {
  if (!holds) refuse(what);
}

/// The symmetric matrix with every eigenvalue at least `floor`.
MeasurementMatrix raised(const MeasurementMatrix& symmetric, double floor) {
  const Eigen::SelfAdjointEigenSolver<MeasurementMatrix> solver(symmetric);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(floor).asDiagonal() *
         solver.eigenvectors().transpose();
}

}  // namespace

SageHusa::SageHusa(const NoiseAdaptationParameters& parameters,
                   std::vector<NoiseComponent> components, GateProbabilities gate)
    : parameters_(parameters),
      components_(std::move(components)),
      classic_(parameters.method == "classic"),
      grows_(std::ranges::any_of(components_,
                                 [](const NoiseComponent& c) { return c.growth_per_m > 0.0; })) {
  if (parameters.method != "residual" && !classic_)
    refuse("unknown method '" + parameters.method + "'");
  if (!(parameters.forgetting > 0.0 && parameters.forgetting < 1.0))
    refuse("forgetting must be in (0, 1), got " + std::to_string(parameters.forgetting));
  if (!(parameters.prior_weight >= 1.0))
    refuse("prior_weight must be >= 1, got " + std::to_string(parameters.prior_weight));
  if (parameters.channels < 1)
    refuse("channels must be >= 1, got " + std::to_string(parameters.channels));
  if (components_.empty() || components_.size() > kMaxMeasurementDimension)
    refuse("measurements of dimension " + std::to_string(components_.size()));
  for (const NoiseComponent& c : components_)
    if (!(c.floor > 0.0 && c.floor < c.ceiling))
      refuse("the floor of sigma of " + c.name + " must be positive and below its ceiling");
  const auto dimension = static_cast<Index>(components_.size());
  kappa_identified_ = gated_covariance(gate.identified, static_cast<int>(dimension));
  kappa_anonymous_ = gated_covariance(gate.anonymous, static_cast<int>(dimension));
  Channel start;
  start.belief.factor = start.sum = MeasurementMatrix::Identity(dimension, dimension);
  start.belief.bias = start.sum_innovation = MeasurementVector::Zero(dimension);
  start.belief.weight = parameters.prior_weight;
  start.reference = MeasurementMatrix::Zero(dimension, dimension);
  for (Index j = 0; j < dimension; ++j)
    start.reference(j, j) = components_[static_cast<std::size_t>(j)].configured;
  channels_.assign(static_cast<std::size_t>(parameters.channels), start);
}

std::size_t SageHusa::slot(int channel) const {
  require(channel >= 0, "a channel below 0");
  return std::min(static_cast<std::size_t>(channel), channels_.size() - 1);
}

MeasurementMatrix SageHusa::shape_of(const Feature& feature, Channel& channel) const {
  const auto dimension = static_cast<Index>(components_.size());
  if (feature.z.size() != dimension || feature.cov.rows() != dimension)
    refuse("a feature of dimension " + std::to_string(feature.z.size()) + ", expected " +
           std::to_string(dimension));
  const Eigen::LLT<MeasurementMatrix> factor(feature.cov);
  require(factor.info() == Eigen::Success, "the covariance of a feature is not positive definite");
  MeasurementMatrix shape = factor.matrixL();
  if (!channel.seen) {
    channel.reference = shape;
    channel.seen = true;
  }
  for (Index j = 0; j < dimension; ++j) {
    const double growth = components_[static_cast<std::size_t>(j)].growth_per_m;
    if (growth > 0.0) shape.row(j) *= 1.0 + growth * distance_of(feature);
  }
  return shape;
}

/// A congruence, and slightly smaller correlations: neither can make a matrix less definite.
void SageHusa::bound(MeasurementMatrix& cov) const {
  for (Index j = 0; j < cov.rows(); ++j) {
    const NoiseComponent& c = components_[static_cast<std::size_t>(j)];
    if (!(cov(j, j) > 0.0)) continue;  // an innovation form that nobody repairs
    const double sigma = std::sqrt(cov(j, j)),
                 scale = std::clamp(sigma, c.floor, c.ceiling) / sigma;
    if (scale == 1.0) continue;
    cov.row(j) *= scale;
    cov.col(j) *= scale;
  }
  if (classic_) return;  // repaired by its eigenvalues, or not at all
  const MeasurementMatrix diagonal = cov.diagonal().asDiagonal();
  cov += kIndependence * (diagonal - cov);
}

void SageHusa::believe(Group& group) const {
  const MeasurementMatrix half = group.shape * channels_[group.channel].belief.factor;
  group.cov.noalias() = half * group.shape.transpose();
  bound(group.cov);
}

void SageHusa::apply(std::span<Feature> features) {
  for (Channel& channel : channels_) channel.before = channel.belief;
  rounds_ = 0;
  groups_.clear();
  group_of_.clear();
  for (Feature& feature : features) {
    const std::size_t which = slot(feature.channel);
    // Most sensors give all their features the same covariance.
    if (groups_.empty() || grows_ || groups_.back().channel != which ||
        groups_.back().configured.rows() != feature.cov.rows() ||
        groups_.back().configured != feature.cov) {
      Group& group = groups_.emplace_back();
      group.channel = which;
      group.configured = feature.cov;
      group.shape = shape_of(feature, channels_[which]);
      believe(group);
    }
    group_of_.push_back(groups_.size() - 1);
    feature.cov = groups_.back().cov;
    if (parameters_.bias) feature.z -= channels_[which].belief.bias;
  }
}

void SageHusa::begin_round() {
  const auto dimension = static_cast<Index>(components_.size());
  for (Channel& channel : channels_) {
    channel.weighed_with = channel.belief.factor.diagonal();
    channel.belief = channel.before;
    channel.sum.setZero();
    channel.sum_innovation.setZero();
    channel.count = 0;
  }
  for (Group& group : groups_) {
    group.sum.setZero(dimension, dimension);
    group.count = 0;
  }
}

bool SageHusa::observe(std::span<Feature> features, std::span<const Postfit> accepted) {
  require(features.size() == group_of_.size(), "other features than those that apply has seen");
  begin_round();
  for (const Postfit& postfit : accepted) {
    require(postfit.innovation.size() == static_cast<Index>(components_.size()),
            "a measurement that leaves out rows of its feature");
    Group& group = groups_[group_of_[postfit.feature]];
    const double kappa =
        features[postfit.feature].id == kNoIdentity ? kappa_anonymous_ : kappa_identified_;
    add_square(classic_ ? postfit.innovation : postfit.weighted, kappa,
               classic_ ? postfit.cov_innovation : postfit.information, group.sum);
    ++group.count;
    if (parameters_.bias) channels_[group.channel].sum_innovation += postfit.innovation;
  }
  for (const Group& group : groups_)
    if (group.count > 0) add(group);
  for (Channel& channel : channels_)
    if (channel.count > 0) blend(channel);
  return !classic_ && reconsider(features);
}

void SageHusa::add(const Group& group) {
  Channel& channel = channels_[group.channel];
  MeasurementMatrix added = group.sum;
  if (!classic_) added = group.cov * group.sum * group.cov;
  added += group.count * group.cov;
  divide(group.shape, added);
  divide(group.shape, added.transpose());
  channel.sum += added;
  channel.count += group.count;
}

/// The noise that these features show is theirs, too; where it is another than the one that they
/// were weighed with, the answer changes with the weights.
bool SageHusa::reconsider(std::span<Feature> features) {
  double change = 0.0;
  for (const Channel& channel : channels_) {
    if (channel.count == 0) continue;
    const auto now = channel.belief.factor.diagonal();
    change = std::max(
        change,
        (now - channel.weighed_with).cwiseQuotient(channel.weighed_with).cwiseAbs().maxCoeff());
  }
  if (!(change > kWorthAnotherRound) || ++rounds_ > kMostRounds) return false;
  for (Group& group : groups_) believe(group);
  for (std::size_t i = 0; i < features.size(); ++i) features[i].cov = groups_[group_of_[i]].cov;
  return true;
}

void SageHusa::blend(Channel& channel) const {
  channel.belief.weight = parameters_.forgetting * channel.belief.weight + channel.count;
  const double share = 1.0 / channel.belief.weight, d = share * channel.count;
  channel.belief.factor = (1.0 - d) * channel.belief.factor +
                          0.5 * share * (channel.sum + channel.sum.transpose()).eval();
  if (classic_ && parameters_.eigenvalue_floor > 0.0)
    channel.belief.factor = raised(channel.belief.factor, parameters_.eigenvalue_floor);
  if (parameters_.bias) channel.belief.bias += share * channel.sum_innovation;
}

std::vector<AdaptedNoise> SageHusa::noise() const {
  std::vector<AdaptedNoise> all;
  all.reserve(channels_.size() * components_.size());
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const Channel& channel = channels_[c];
    MeasurementMatrix cov =
        channel.reference * channel.belief.factor * channel.reference.transpose();
    bound(cov);
    for (std::size_t j = 0; j < components_.size(); ++j) {
      const auto row = static_cast<Index>(j);
      AdaptedNoise& noise = all.emplace_back();
      noise.name = components_[j].name;
      if (channels_.size() > 1) noise.name.append("_").append(std::to_string(c + 1));
      noise.sigma = std::sqrt(std::max(cov(row, row), 0.0));
      noise.configured = channel.reference.row(row).norm();
      noise.unit = components_[j].unit;
    }
  }
  return all;
}

}  // namespace libslam
