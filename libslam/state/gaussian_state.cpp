#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include <libslam/state/dense_covariance.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

namespace {

using Eigen::Index;

void require_shape(const BlockSpec& spec, const char* what, Index rows, Index cols, Index want_rows,
                   Index want_cols) {
  if (rows == want_rows && cols == want_cols) return;
  throw std::invalid_argument("block '" + spec.name + "': " + what + " is " + std::to_string(rows) +
                              " x " + std::to_string(cols) + ", expected " +
                              std::to_string(want_rows) + " x " + std::to_string(want_cols));
}

void require_error(const BlockSpec& spec, bool constant) {
  if (constant) throw std::invalid_argument("block '" + spec.name + "' is a constant");
}

}  // namespace

GaussianState::GaussianState() : GaussianState(std::make_unique<DenseCovariance>()) {}

GaussianState::GaussianState(std::unique_ptr<CovarianceStore> covariance)
    : covariance_(std::move(covariance)) {}

GaussianState::GaussianState(const GaussianState& other)
    : slots_(other.slots_),
      order_(other.order_),
      free_(other.free_),
      storage_(other.storage_),
      constants_(other.constants_),
      used_(other.used_),
      dimension_(other.dimension_),
      covariance_(other.covariance_->clone()) {}

GaussianState& GaussianState::operator=(const GaussianState& other) {
  if (this != &other) *this = GaussianState(other);
  return *this;
}

const GaussianState::Slot& GaussianState::slot(BlockId block) const {
  if (!alive(block))
    throw std::out_of_range("state has no block with handle " + std::to_string(block.value));
  return slots_[static_cast<std::size_t>(block.value)];
}

bool GaussianState::alive(BlockId block) const {
  return block.value >= 0 && static_cast<std::size_t>(block.value) < slots_.size() &&
         slots_[static_cast<std::size_t>(block.value)].alive;
}

void GaussianState::reserve(Index tangent) {
  covariance_->reserve(tangent);
  if (storage_.size() < tangent) storage_.conservativeResize(tangent);
}

int GaussianState::free_slot() {
  if (free_.empty()) {
    slots_.emplace_back();
    return static_cast<int>(slots_.size()) - 1;
  }
  const int index = free_.back();
  free_.pop_back();
  return index;
}

BlockId GaussianState::append(const BlockSpec& spec, const VectorRef& estimate) {
  require_shape(spec, "estimate", estimate.size(), 1, storage_dimension(spec), 1);
  if (used_ + estimate.size() > storage_.size())
    storage_.conservativeResize(std::max<Index>(2 * storage_.size(), used_ + 16));
  const int index = free_slot();
  slots_[static_cast<std::size_t>(index)] = {
      spec, dimension_, tangent_dimension(spec), used_, estimate.size(), true, false};
  storage_.segment(used_, estimate.size()) = estimate;
  used_ += estimate.size();
  dimension_ += tangent_dimension(spec);
  order_.push_back({index});
  return {index};
}

BlockId GaussianState::add(const BlockSpec& spec, const VectorRef& estimate, const MatrixRef& cov) {
  const Index d = tangent_dimension(spec);
  require_shape(spec, "covariance", cov.rows(), cov.cols(), d, d);
  require_shape(spec, "estimate", estimate.size(), 1, storage_dimension(spec), 1);
  covariance_->augment({}, BlockMatrix(cov));
  return append(spec, estimate);
}

BlockId GaussianState::add_constant(const BlockSpec& spec, const VectorRef& estimate) {
  require_shape(spec, "estimate", estimate.size(), 1, storage_dimension(spec), 1);
  const int index = free_slot();
  slots_[static_cast<std::size_t>(index)] = {
      spec, 0, 0, static_cast<Index>(constants_.size()), estimate.size(), true, true};
  constants_.insert(constants_.end(), estimate.data(), estimate.data() + estimate.size());
  return {index};
}

BlockId GaussianState::augment(const BlockSpec& spec, const Initialization& initialization) {
  const Index d = tangent_dimension(spec);
  require_shape(spec, "noise", initialization.cov_noise.rows(), initialization.cov_noise.cols(), d,
                d);
  require_shape(spec, "estimate", initialization.estimate.size(), 1, storage_dimension(spec), 1);
  std::array<PlacedJacobian, BlockJacobians::kCapacity> placed;
  std::size_t count = 0;
  for (const auto& [block, jacobian] : initialization.wrt) {
    require_shape(spec, "Jacobian", jacobian.rows(), jacobian.cols(), d, size(block));
    placed[count++] = {offset(block), jacobian};
  }
  covariance_->augment(std::span(placed.data(), count), initialization.cov_noise);
  return append(spec, initialization.estimate);
}

BlockId GaussianState::clone(BlockId block, const std::string& name) {
  BlockSpec copy = spec(block);
  copy.name = name;
  const Index d = size(block);
  Initialization identity;
  identity.estimate = estimate(block);
  identity.wrt.add(block, d, d).setIdentity();
  identity.cov_noise.setZero(d, d);
  return augment(copy, identity);
}

void GaussianState::remove(BlockId block) {
  const Slot removed = slot(block);
  slots_[static_cast<std::size_t>(block.value)].alive = false;
  free_.push_back(block.value);
  if (removed.constant) return;
  covariance_->remove(removed.offset, removed.tangent);
  const Index behind = used_ - removed.storage_offset - removed.storage;
  for (Index i = 0; i < behind; ++i)
    storage_[removed.storage_offset + i] = storage_[removed.storage_offset + removed.storage + i];
  used_ -= removed.storage;
  dimension_ -= removed.tangent;
  const auto position = std::find(order_.begin(), order_.end(), block);
  for (auto later = position + 1; later != order_.end(); ++later) {
    auto& moved = slots_[static_cast<std::size_t>(later->value)];
    moved.offset -= removed.tangent;
    moved.storage_offset -= removed.storage;
  }
  order_.erase(position);
}

std::optional<BlockId> GaussianState::find(std::string_view name) const {
  for (const BlockId block : order_)
    if (spec(block).name == name) return block;
  return std::nullopt;
}

Eigen::Map<const Eigen::VectorXd> GaussianState::estimate(BlockId block) const {
  const Slot& s = slot(block);
  return {(s.constant ? constants_.data() : storage_.data()) + s.storage_offset, s.storage};
}

void GaussianState::set_estimate(BlockId block, const VectorRef& estimate) {
  const Slot& s = slot(block);
  require_shape(s.spec, "estimate", estimate.size(), 1, s.storage, 1);
  require_error(s.spec, s.constant);
  storage_.segment(s.storage_offset, s.storage) = estimate;
}

GaussianState::MutableBlock GaussianState::mutable_block(BlockId block) {
  const Slot& s = slot(block);
  require_error(s.spec, s.constant);
  return {s.spec, s.offset, s.tangent, {storage_.data() + s.storage_offset, s.storage}};
}

BlockMatrix GaussianState::covariance_of(BlockId block) const {
  return cross_covariance(block, block);
}

BlockMatrix GaussianState::cross_covariance(BlockId row, BlockId col) const {
  const Slot &r = slot(row), &c = slot(col);
  if (r.constant || c.constant)
    return BlockMatrix::Zero(tangent_dimension(r.spec), tangent_dimension(c.spec));
  BlockMatrix out(r.tangent, c.tangent);
  covariance_->marginal(r.offset, c.offset, out);
  return out;
}

Eigen::MatrixXd GaussianState::full_covariance() const {
  Eigen::MatrixXd out(dimension_, dimension_);
  covariance_->marginal(0, 0, out);
  return out;
}

}  // namespace libslam
