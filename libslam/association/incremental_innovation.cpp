#include <cmath>
#include <limits>

#include <libslam/association/incremental_innovation.hpp>

namespace libslam {

void IncrementalInnovation::reset(const Compatibility& pairs) {
  pairs_ = &pairs;
  clear();
}

void IncrementalInnovation::clear() {
  taken_.clear();
  rows_ = 0;
}

void IncrementalInnovation::make_room(Eigen::Index rows) {
  if (lower_.rows() >= rows) return;
  lower_.conservativeResize(2 * rows, 2 * rows);
  white_.conservativeResize(2 * rows);
}

Match IncrementalInnovation::extend(std::size_t pair) {
  const MeasurementVector& nu = pairs_->innovation(pair);
  next_ = {pair, rows_, nu.size(), {mahalanobis2(), log_det()}};
  make_room(rows_ + next_.rows);
  for (const Taken& taken : taken_)
    lower_.block(rows_, taken.first_row, next_.rows, taken.rows) =
        pairs_->covariance(pair, taken.pair);
  lower_.block(rows_, rows_, next_.rows, next_.rows) = pairs_->covariance(pair, pair);
  Match added;
  for (Eigen::Index r = 0; r < next_.rows; ++r) {
    const Eigen::Index row = rows_ + r;
    double* x = lower_.row(row).data();
    for (Eigen::Index c = 0; c <= row; ++c) {
      const double* l = lower_.row(c).data();
      double sum = x[c];
      for (Eigen::Index k = 0; k < c; ++k) sum -= x[k] * l[k];
      if (c < row) {
        x[c] = sum / l[c];
      } else if (sum > 0.0) {
        x[c] = std::sqrt(sum);
      } else {
        return {std::numeric_limits<double>::infinity(), 0.0};
      }
    }
    white_[row] = (nu[r] - lower_.row(row).head(row).dot(white_.head(row))) / x[row];
    added.mahalanobis2 += white_[row] * white_[row];
    added.log_det += 2.0 * std::log(x[row]);
  }
  next_.sum.mahalanobis2 += added.mahalanobis2;
  next_.sum.log_det += added.log_det;
  return added;
}

void IncrementalInnovation::push() {
  taken_.push_back(next_);
  rows_ += next_.rows;
}

void IncrementalInnovation::pop() {
  rows_ = taken_.back().first_row;
  taken_.pop_back();
}

}  // namespace libslam
