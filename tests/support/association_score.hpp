#pragma once
// How many pairs of many frames are wrong, and what a frame costs; libslam's methods and MRPT's on
// the same frames.

#include <algorithm>
#include <ctime>
#include <support/association_scene.hpp>
#include <vector>

#include <mrpt/slam/data_association.h>

#include <libslam/association/joint_compatibility.hpp>
#include <libslam/association/nearest_neighbour.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam::testing {

struct AssociationScore {
  long observed = 0, mapped = 0, pairs = 0, wrong = 0;
  long wrongly_new = 0;    ///< observations of mapped landmarks that would start a landmark
  std::vector<double> ms;  ///< CPU time of each frame

  double wrong_share() const {
    return pairs > 0 ? static_cast<double>(wrong) / static_cast<double>(pairs) : 0.0;
  }
  /// Of the observations of mapped landmarks.
  double right_share() const {
    return static_cast<double>(pairs - wrong) / static_cast<double>(std::max(1L, mapped));
  }
  double median_ms() const { return quantile(0.5); }
  double slowest_ms() const { return quantile(1.0); }

  void add(const AssociationScene& scene, const std::vector<Verdict>& verdicts, double spent) {
    ms.push_back(spent);
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      const bool is_mapped = scene.partners[i] != AssociationScene::kUnmapped;
      ++observed;
      mapped += is_mapped;
      wrongly_new += is_mapped && verdicts[i].outcome == Outcome::kNew;
      if (verdicts[i].outcome != Outcome::kPaired) continue;
      ++pairs;
      wrong += verdicts[i].landmark != scene.partners[i];
    }
  }

 private:
  double quantile(double part) const {
    if (ms.empty()) return 0.0;
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  }
};

inline double cpu_now_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Adds one frame to the score of `associator`.
inline void score(Associator& associator, AssociationScene& scene, AssociationScore& total) {
  std::vector<Verdict> verdicts;
  PairTest test = scene.test();
  const double begin = cpu_now_ms();
  associator.associate(scene.features, scene.registry, test, verdicts);
  total.add(scene, verdicts, cpu_now_ms() - begin);
}

/// MRPT's JCBB by Mahalanobis distance with the same gate; its predictions and their covariance
/// are not part of its time.
inline void score_mrpt(AssociationScene& scene, double gate_probability, AssociationScore& total) {
  Eigen::MatrixXd mean, cov;
  scene.predict(mean, cov);
  const auto rows = static_cast<Eigen::Index>(scene.features.size());
  Eigen::MatrixXd seen(rows, 2);
  for (Eigen::Index i = 0; i < rows; ++i)
    seen.row(i) = scene.features[static_cast<std::size_t>(i)].z.transpose();
  const mrpt::math::CMatrixDouble z(seen), y(mean), s(cov);
  mrpt::slam::TDataAssociationResults results;
  const double begin = cpu_now_ms();
  mrpt::slam::data_association_full_covariance(z, y, s, results, mrpt::slam::assocJCBB,
                                               mrpt::slam::metricMaha, gate_probability);
  const double spent = cpu_now_ms() - begin;
  std::vector<Verdict> verdicts(scene.features.size());
  for (const auto& [feature, landmark] : results.associations)
    verdicts[feature] = {Outcome::kPaired, landmark};
  total.add(scene, verdicts, spent);
}

}  // namespace libslam::testing
