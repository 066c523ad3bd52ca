#pragma once
// Association by the identities of the log, with another method for features that have none.

#include <memory>
#include <vector>

#include <libslam/association/associator.hpp>

namespace libslam {

/// A feature whose identity is in the map is paired if it passes the gate; an unknown identity is a
/// new landmark; a second feature with the same identity is ambiguous. Features without identity go
/// to `unidentified`, which may not take landmarks that are paired already; without it they are
/// ambiguous.
class KnownAssociation final : public Associator {
 public:
  /// `gate`: largest accepted squared Mahalanobis distance; infinity accepts all.
  explicit KnownAssociation(double gate, std::unique_ptr<Associator> unidentified = nullptr);
  void associate(std::span<const Feature> features, const LandmarkRegistry& registry,
                 Compatibility& compatibility, std::vector<Verdict>& verdicts) override;

 private:
  void associate_unidentified(std::span<const Feature> features, const LandmarkRegistry& registry,
                              Compatibility& compatibility, std::vector<Verdict>& verdicts);

  double gate_;
  std::unique_ptr<Associator> unidentified_;
  std::vector<Feature> rest_;
  std::vector<std::size_t> rest_index_;
  std::vector<Verdict> rest_verdicts_;
};

}  // namespace libslam
