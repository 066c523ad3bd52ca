#pragma once
// The innovation of a growing set of pairs: distance and determinant, one pair at a time.
//
//   S = L L^T,  d^2 = |L^-1 nu|^2,  log|S| = 2 sum log L_kk
//
// A further pair adds rows at the bottom of L and leaves the rest: O(k) blocks of S and O(k^2)
// products for pair k, where a new factor would cost O(k^3). What a pair adds to d^2 is its squared
// distance given the pairs before it. Source: Neira & Tardos 2001, section IV-C (there with the
// inverse of S).

#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/association/associator.hpp>

namespace libslam {

class IncrementalInnovation {
 public:
  /// Starts from no pair; `pairs` holds the selected ones and must outlive this.
  void reset(const Compatibility& pairs);
  void clear();

  /// What `pair` (by its number in the selection) would add to distance and determinant. An
  /// infinite distance where S would not be positive definite.
  Match extend(std::size_t pair);
  /// Takes the pair of the last call of `extend`.
  void push();
  /// Gives up the pair taken last.
  void pop();

  std::size_t size() const { return taken_.size(); }
  Eigen::Index rows() const { return rows_; }
  double mahalanobis2() const { return taken_.empty() ? 0.0 : taken_.back().sum.mahalanobis2; }
  double log_det() const { return taken_.empty() ? 0.0 : taken_.back().sum.log_det; }

 private:
  struct Taken {
    std::size_t pair;
    Eigen::Index first_row, rows;
    Match sum;  // of all pairs up to this one
  };
  void make_room(Eigen::Index rows);

  const Compatibility* pairs_ = nullptr;
  std::vector<Taken> taken_;
  Eigen::Index rows_ = 0;
  Taken next_{};
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> lower_;
  Eigen::VectorXd white_;  // L^-1 nu
};

}  // namespace libslam
