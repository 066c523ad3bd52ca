#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include <libslam/association/landmark_registry.hpp>

namespace libslam {

LandmarkRegistry::LandmarkRegistry(int confirm_after, int prune_after, std::int64_t first_number,
                                   int forget_after)
    : confirm_after_(confirm_after),
      prune_after_(prune_after),
      forget_after_(forget_after),
      next_number_(first_number) {}

std::optional<std::size_t> LandmarkRegistry::find(std::int64_t id) const {
  const auto found = by_id_.find(id);
  if (found == by_id_.end()) return std::nullopt;
  return found->second;
}

void LandmarkRegistry::add(BlockId block, std::int64_t id,
                           std::shared_ptr<const Descriptor> appearance) {
  if (id == kNoIdentity) id = next_number_++;
  by_id_[id] = landmarks_.size();
  landmarks_.push_back({block, id, 1, 0, confirm_after_ <= 1, std::move(appearance), 0});
}

void LandmarkRegistry::restore(const RegisteredLandmark& landmark) {
  if (landmark.id == kNoIdentity || !by_id_.emplace(landmark.id, landmarks_.size()).second)
    throw std::invalid_argument("landmark " + std::to_string(landmark.id) + " cannot be restored");
  landmarks_.push_back(landmark);
}

void LandmarkRegistry::number_from(std::int64_t number) {
  next_number_ = std::max(next_number_, number);
}

void LandmarkRegistry::record_sighting(std::size_t landmark,
                                       std::shared_ptr<const Descriptor> appearance) {
  auto& seen = landmarks_[landmark];
  if (appearance) seen.appearance = std::move(appearance);
  if (++seen.times_seen >= confirm_after_) seen.confirmed = true;
  seen.unseen = 0;
}

bool LandmarkRegistry::given_up(const RegisteredLandmark& landmark) const {
  if (forget_after_ > 0 && landmark.unseen > forget_after_) return true;
  return prune_after_ > 0 && !landmark.confirmed && landmark.updates > prune_after_;
}

std::vector<BlockId> LandmarkRegistry::record_update() {
  for (auto& landmark : landmarks_) {
    ++landmark.updates;
    ++landmark.unseen;
  }
  return clear_if([this](const RegisteredLandmark& landmark) { return given_up(landmark); });
}

std::vector<BlockId> LandmarkRegistry::clear_younger(int updates) {
  return clear_if(
      [updates](const RegisteredLandmark& landmark) { return landmark.updates < updates; });
}

template <class Condition>
std::vector<BlockId> LandmarkRegistry::clear_if(Condition condition) {
  std::vector<BlockId> gone;
  for (const RegisteredLandmark& landmark : landmarks_)
    if (condition(landmark)) gone.push_back(landmark.block);
  if (gone.empty()) return gone;
  std::erase_if(landmarks_, condition);
  by_id_.clear();
  for (std::size_t i = 0; i < landmarks_.size(); ++i) by_id_[landmarks_[i].id] = i;
  return gone;
}

std::vector<BlockId> LandmarkRegistry::clear() {
  std::vector<BlockId> gone;
  for (const auto& landmark : landmarks_) gone.push_back(landmark.block);
  landmarks_.clear();
  by_id_.clear();
  return gone;
}

}  // namespace libslam
