#pragma once
// Joint compatibility branch and bound (JCBB): the features of one observation are paired together.
//
//   A hypothesis pairs each feature with one landmark or none, no landmark twice. It is accepted if
//   nu^T S^-1 nu of its stacked innovations is below the chi-square quantile of its dimension.
//   Best: most pairs, then least d^2 + log|S|.
//
// An error of the pose shifts all innovations alike. Tests of single pairs cannot see that, the
// joint test does: two pairs that need different poses do not fit together.
// Source: Neira & Tardos, "Data association in stochastic mapping using the joint compatibility
// test", IEEE T-RA 17(6), 2001, figure 3. Not from there: the budget, the greedy start, the rule
// for hypotheses that are about equally likely, and the verdict on features without a pair.

#include <limits>
#include <vector>

#include <libslam/association/associator.hpp>
#include <libslam/association/incremental_innovation.hpp>

namespace libslam {

struct JointCompatibilityOptions {
  double gate_probability = 0.99;  ///< of a pair, and of the pairs of a hypothesis together
  double new_landmark_probability = 0.999;  ///< beyond it from every landmark: a new one
  int dimension = 2;                        ///< rows of one measurement
  /// Most blocks of factors computed for one frame: bounds the time, and cuts off at the same place
  /// on every machine. 300 000 are about 12 ms.
  std::size_t budget = 300'000;
};

/// Features with the fewest candidates come first, and their candidates in the order of their
/// likelihood given the pairs before. When the budget is used up, the best hypothesis so far
/// counts; the greedy completion of single pairs provides one before the search begins. Frames with
/// more than `kMaxPairs` candidate pairs leave the features with the most candidates ambiguous.
///
/// A pair that another hypothesis denies which is as large and has at least one
/// `kLikelihoodRatio`th of the likelihood is not used: its feature is ambiguous. The other features
/// without a pair are new if, given the pairs of the hypothesis, they are beyond the new-landmark
/// gate of every landmark, otherwise ambiguous; after a search that was cut off all are ambiguous.
class JointCompatibility final : public Associator {
 public:
  static constexpr double kLikelihoodRatio = 20.0;  ///< as in NearestNeighbour
  static constexpr std::size_t kMaxPairs = 400;

  /// Throws std::invalid_argument unless 0 < gate_probability <= new_landmark_probability < 1.
  explicit JointCompatibility(const JointCompatibilityOptions& options);
  void associate(std::span<const Feature> features, const LandmarkRegistry& registry,
                 Compatibility& compatibility, std::vector<Verdict>& verdicts) override;

  // Of the last frame: the best hypothesis, with the pairs that were not used because another
  // denies them, and whether the search was cut off.
  std::vector<Pairing> hypothesis() const;
  bool exhausted() const { return spent_ > options_.budget; }

 private:
  static constexpr int kNone = -1;

  /// A feature with its pairs [first, end) in pairs_; those before `gated` are within the gate.
  struct Candidates {
    std::size_t feature, first, gated, end;
  };
  struct Hypothesis {
    std::vector<int> pair;  // of each of features_, or kNone
    std::size_t size = 0;
    double cost = std::numeric_limits<double>::infinity();
  };
  struct Option {
    double cost;
    std::size_t pair;
  };

  void collect(std::span<const Feature> features, std::size_t landmarks,
               Compatibility& compatibility, std::vector<Verdict>& verdicts);
  void prepare(Compatibility& compatibility, std::size_t landmarks);
  void limit_pairs();
  void start_greedily();
  void complete_greedily(std::size_t seeded);
  void branch(std::size_t depth);
  bool worthwhile(std::size_t depth) const;
  /// Appends the jointly compatible candidates of a feature to open_, the likeliest first.
  void append_options(std::size_t depth);
  void take(std::size_t depth, std::size_t pair);
  void give_up(std::size_t depth);
  void offer();
  void conclude(std::vector<Verdict>& verdicts);
  /// Given the pairs in joint_.
  bool beyond_all_landmarks(const Candidates& candidates);
  double gate(std::size_t pairs);

  JointCompatibilityOptions options_;
  double pair_gate_, new_landmark_gate_, margin_;
  std::vector<double> gates_;  // by number of pairs
  std::vector<Pairing> pairs_;
  std::vector<Candidates> features_;
  /// Of the features from here on: a pair adds at least the determinant of its noise to log|S|.
  std::vector<double> least_log_det_;
  std::vector<bool> taken_;      // landmarks
  std::vector<bool> contested_;  // features
  std::vector<Option> open_;     // of all depths
  IncrementalInnovation joint_;
  Hypothesis current_, best_;
  std::vector<Hypothesis> rivals_;
  std::size_t spent_ = 0;
};

}  // namespace libslam
