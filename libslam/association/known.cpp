#include <algorithm>

#include <libslam/association/known.hpp>

namespace libslam {

namespace {

/// The pairs that are left when some features and landmarks are taken.
class Remaining final : public Compatibility {
 public:
  Remaining(Compatibility& all, const std::vector<std::size_t>& features,
            const std::vector<Verdict>& verdicts)
      : all_(all), features_(features), verdicts_(verdicts) {}
  std::optional<Match> test(std::size_t feature, std::size_t landmark, double limit) override {
    const bool taken =
        std::any_of(verdicts_.begin(), verdicts_.end(), [landmark](const Verdict& verdict) {
          return verdict.outcome == Outcome::kPaired && verdict.landmark == landmark;
        });
    if (taken) return std::nullopt;
    return all_.test(features_[feature], landmark, limit);
  }
  void select(std::span<const Pairing> pairs) override {
    std::vector<Pairing> of_all(pairs.begin(), pairs.end());
    for (Pairing& pair : of_all) pair.feature = features_[pair.feature];
    all_.select(of_all);
  }
  const MeasurementVector& innovation(std::size_t pair) const override {
    return all_.innovation(pair);
  }
  const MeasurementMatrix& noise(std::size_t pair) const override { return all_.noise(pair); }
  MeasurementMatrix covariance(std::size_t first, std::size_t second) const override {
    return all_.covariance(first, second);
  }

 private:
  Compatibility& all_;
  const std::vector<std::size_t>& features_;
  const std::vector<Verdict>& verdicts_;
};

}  // namespace

KnownAssociation::KnownAssociation(double gate, std::unique_ptr<Associator> unidentified)
    : gate_(gate), unidentified_(std::move(unidentified)) {}

void KnownAssociation::associate(std::span<const Feature> features,
                                 const LandmarkRegistry& registry, Compatibility& compatibility,
                                 std::vector<Verdict>& verdicts) {
  verdicts.assign(features.size(), {});
  for (std::size_t i = 0; i < features.size(); ++i) {
    const std::int64_t id = features[i].id;
    const auto earlier = features.first(i);
    const bool repeated = std::any_of(earlier.begin(), earlier.end(),
                                      [id](const Feature& other) { return other.id == id; });
    if (id == kNoIdentity || repeated) continue;
    const auto landmark = registry.find(id);
    if (!landmark) {
      verdicts[i].outcome = Outcome::kNew;
      continue;
    }
    const auto match = compatibility.test(i, *landmark, gate_);
    const bool fits = match && match->mahalanobis2 <= gate_;
    verdicts[i] = {fits ? Outcome::kPaired : Outcome::kGated, *landmark};
  }
  if (unidentified_) associate_unidentified(features, registry, compatibility, verdicts);
}

void KnownAssociation::associate_unidentified(std::span<const Feature> features,
                                              const LandmarkRegistry& registry,
                                              Compatibility& compatibility,
                                              std::vector<Verdict>& verdicts) {
  rest_.clear();
  rest_index_.clear();
  for (std::size_t i = 0; i < features.size(); ++i)
    if (features[i].id == kNoIdentity) {
      rest_.push_back(features[i]);
      rest_index_.push_back(i);
    }
  Remaining remaining(compatibility, rest_index_, verdicts);
  unidentified_->associate(rest_, registry, remaining, rest_verdicts_);
  for (std::size_t i = 0; i < rest_.size(); ++i) verdicts[rest_index_[i]] = rest_verdicts_[i];
}

}  // namespace libslam
