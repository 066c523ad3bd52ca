#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include <Eigen/LU>

#include <libslam/association/joint_compatibility.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {

namespace {

/// The greedy start may use this part of the budget.
constexpr std::size_t kGreedyShare = 3;
/// More hypotheses that are about equally likely do not change the verdict.
constexpr std::size_t kMaxRivals = 64;

}  // namespace

JointCompatibility::JointCompatibility(const JointCompatibilityOptions& options)
    : options_(options), margin_(2.0 * std::log(kLikelihoodRatio)) {
  if (!(options.gate_probability > 0.0 &&
        options.gate_probability <= options.new_landmark_probability &&
        options.new_landmark_probability < 1.0))
    throw std::invalid_argument(
        "the association gate must be positive and not beyond the new-landmark gate, which is "
        "below 1");
  pair_gate_ = chi_square_quantile(options.gate_probability, options.dimension);
  new_landmark_gate_ = chi_square_quantile(options.new_landmark_probability, options.dimension);
}

void JointCompatibility::associate(std::span<const Feature> features,
                                   const LandmarkRegistry& registry, Compatibility& compatibility,
                                   std::vector<Verdict>& verdicts) {
  collect(features, registry.size(), compatibility, verdicts);
  prepare(compatibility, registry.size());
  start_greedily();
  branch(0);
  conclude(verdicts);
}

void JointCompatibility::collect(std::span<const Feature> features, std::size_t landmarks,
                                 Compatibility& compatibility, std::vector<Verdict>& verdicts) {
  verdicts.assign(features.size(), {Outcome::kNew, 0});
  pairs_.clear();
  features_.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    const std::size_t first = pairs_.size();
    std::size_t gated = first;
    for (std::size_t k = 0; k < landmarks; ++k) {
      const auto match = compatibility.test(i, k, new_landmark_gate_);
      if (!match || match->mahalanobis2 > new_landmark_gate_) continue;
      pairs_.push_back({i, k});
      if (match->mahalanobis2 <= pair_gate_) std::swap(pairs_[gated++], pairs_.back());
    }
    if (first == pairs_.size()) continue;
    verdicts[i].outcome = Outcome::kAmbiguous;
    features_.push_back({i, first, gated, pairs_.size()});
  }
  std::sort(features_.begin(), features_.end(), [](const Candidates& a, const Candidates& b) {
    return std::tuple(a.gated - a.first, a.feature) < std::tuple(b.gated - b.first, b.feature);
  });
  limit_pairs();
}

void JointCompatibility::limit_pairs() {
  std::size_t count = 0, kept = 0;
  while (kept < features_.size()) {
    count += features_[kept].end - features_[kept].first;
    if (count > kMaxPairs) break;
    ++kept;
  }
  features_.resize(kept);
}

void JointCompatibility::prepare(Compatibility& compatibility, std::size_t landmarks) {
  compatibility.select(pairs_);
  joint_.reset(compatibility);
  taken_.assign(landmarks, false);
  open_.clear();
  rivals_.clear();
  spent_ = 0;
  least_log_det_.assign(features_.size() + 1, 0.0);
  for (std::size_t i = features_.size(); i-- > 0;) {
    const double noise = compatibility.noise(features_[i].first).determinant();
    least_log_det_[i] = least_log_det_[i + 1] + std::log(noise);
  }
  current_.pair.assign(features_.size(), kNone);
  current_.size = 0;
  best_ = current_;
  best_.cost = 0.0;  // no pairs
}

double JointCompatibility::gate(std::size_t pairs) {
  while (gates_.size() < pairs)
    gates_.push_back(chi_square_quantile(options_.gate_probability,
                                         options_.dimension * static_cast<int>(gates_.size() + 1)));
  return gates_[pairs - 1];
}

void JointCompatibility::append_options(std::size_t depth) {
  const std::size_t first = open_.size();
  const double limit = gate(joint_.size() + 1) - joint_.mahalanobis2();
  for (std::size_t pair = features_[depth].first; pair < features_[depth].gated; ++pair) {
    if (taken_[pairs_[pair].landmark]) continue;
    spent_ += (joint_.size() + 1) * (joint_.size() + 2) / 2;
    const Match added = joint_.extend(pair);
    if (added.mahalanobis2 <= limit) open_.push_back({added.mahalanobis2 + added.log_det, pair});
  }
  std::sort(open_.begin() + static_cast<std::ptrdiff_t>(first), open_.end(),
            [](const Option& a, const Option& b) {
              return std::tie(a.cost, a.pair) < std::tie(b.cost, b.pair);
            });
}

void JointCompatibility::take(std::size_t depth, std::size_t pair) {
  joint_.extend(pair);
  joint_.push();
  taken_[pairs_[pair].landmark] = true;
  current_.pair[depth] = static_cast<int>(pair);
  ++current_.size;
}

void JointCompatibility::give_up(std::size_t depth) {
  const auto pair = static_cast<std::size_t>(current_.pair[depth]);
  joint_.pop();
  taken_[pairs_[pair].landmark] = false;
  current_.pair[depth] = kNone;
  --current_.size;
}

void JointCompatibility::start_greedily() {
  for (std::size_t depth = 0; depth < features_.size(); ++depth)
    for (std::size_t pair = features_[depth].first; pair < features_[depth].gated; ++pair) {
      if (spent_ > options_.budget / kGreedyShare) return;
      take(depth, pair);
      complete_greedily(depth);
      give_up(depth);
    }
}

void JointCompatibility::complete_greedily(std::size_t seeded) {
  for (std::size_t depth = 0; depth < features_.size(); ++depth) {
    if (depth == seeded) continue;
    append_options(depth);
    if (!open_.empty()) take(depth, open_.front().pair);
    open_.clear();
  }
  offer();
  for (std::size_t depth = features_.size(); depth-- > 0;)
    if (depth != seeded && current_.pair[depth] != kNone) give_up(depth);
}

void JointCompatibility::offer() {
  current_.cost = joint_.mahalanobis2() + joint_.log_det();
  if (current_.size < best_.size || current_.pair == best_.pair) return;
  if (current_.size > best_.size) rivals_.clear();
  if (current_.size == best_.size && current_.cost > best_.cost + margin_) return;
  if (std::find_if(rivals_.begin(), rivals_.end(), [this](const Hypothesis& rival) {
        return rival.pair == current_.pair;
      }) != rivals_.end())
    return;
  const bool better = current_.size > best_.size || current_.cost < best_.cost;
  const Hypothesis& rival = better ? best_ : current_;
  if (rival.size == current_.size && rivals_.size() < kMaxRivals) rivals_.push_back(rival);
  if (!better) return;
  best_ = current_;
  std::erase_if(rivals_,
                [this](const Hypothesis& other) { return other.cost > best_.cost + margin_; });
}

bool JointCompatibility::worthwhile(std::size_t depth) const {
  const std::size_t reachable = current_.size + features_.size() - depth;
  if (reachable != best_.size) return reachable > best_.size;
  // Only with a pair for every feature from here on is this hypothesis as large as the best.
  const double least = joint_.mahalanobis2() + joint_.log_det() + least_log_det_[depth];
  return least <= best_.cost + margin_;
}

void JointCompatibility::branch(std::size_t depth) {
  if (depth == features_.size()) return offer();
  if (!worthwhile(depth) || spent_ > options_.budget) return;
  const std::size_t first = open_.size();
  append_options(depth);
  for (std::size_t i = first; i < open_.size(); ++i) {
    take(depth, open_[i].pair);
    branch(depth + 1);
    give_up(depth);
  }
  open_.resize(first);
  branch(depth + 1);
}

void JointCompatibility::conclude(std::vector<Verdict>& verdicts) {
  joint_.clear();
  contested_.assign(features_.size(), false);
  for (std::size_t depth = 0; depth < features_.size(); ++depth) {
    for (const Hypothesis& rival : rivals_)
      if (rival.pair[depth] != best_.pair[depth]) contested_[depth] = true;
    if (contested_[depth] || best_.pair[depth] == kNone) continue;
    const auto pair = static_cast<std::size_t>(best_.pair[depth]);
    joint_.extend(pair);
    joint_.push();
    verdicts[features_[depth].feature] = {Outcome::kPaired, pairs_[pair].landmark};
  }
  if (exhausted()) return;  // what a better hypothesis pairs is not new
  for (std::size_t depth = 0; depth < features_.size(); ++depth)
    if (!contested_[depth] && best_.pair[depth] == kNone && beyond_all_landmarks(features_[depth]))
      verdicts[features_[depth].feature].outcome = Outcome::kNew;
}

std::vector<Pairing> JointCompatibility::hypothesis() const {
  std::vector<Pairing> result;
  for (const int pair : best_.pair)
    if (pair != kNone) result.push_back(pairs_[static_cast<std::size_t>(pair)]);
  return result;
}

bool JointCompatibility::beyond_all_landmarks(const Candidates& candidates) {
  for (std::size_t pair = candidates.first; pair < candidates.end; ++pair)
    if (joint_.extend(pair).mahalanobis2 <= new_landmark_gate_) return false;
  return true;
}

}  // namespace libslam
