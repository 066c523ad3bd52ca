#pragma once
// Which landmarks the map holds: identity, block, how often seen, provisional or confirmed.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <libslam/data/feature.hpp>
#include <libslam/state/block.hpp>

namespace libslam {

struct RegisteredLandmark {
  BlockId block;
  std::int64_t id = kNoIdentity;  ///< identity of the log, else a running number
  int times_seen = 1;
  int updates = 0;  ///< updates of the filter since the landmark was added
  bool confirmed = false;
  std::shared_ptr<const Descriptor> appearance = nullptr;  ///< as it was seen last; null: not known
  int unseen = 0;  ///< updates of the filter since the last sighting
};

/// A landmark starts provisional, is confirmed after `confirm_after` sightings and is given up when
/// that has not happened within `prune_after` updates (0: never given up). Any landmark is given up
/// that was not seen in `forget_after` updates in a row (0: never).
class LandmarkRegistry {
 public:
  /// `first_number`: where running numbers begin, beyond every identity of the log.
  LandmarkRegistry(int confirm_after, int prune_after, std::int64_t first_number = 0,
                   int forget_after = 0);

  std::span<const RegisteredLandmark> landmarks() const { return landmarks_; }
  std::size_t size() const { return landmarks_.size(); }
  /// Position of the landmark with an identity from the log.
  std::optional<std::size_t> find(std::int64_t id) const;

  /// Adds a landmark seen for the first time; without an identity it gets the next running number.
  void add(BlockId block, std::int64_t id, std::shared_ptr<const Descriptor> appearance = nullptr);
  /// Adds a landmark of an earlier run as it was. Throws std::invalid_argument if its identity is
  /// taken or none.
  void restore(const RegisteredLandmark& landmark);
  /// The next running number.
  std::int64_t next_number() const { return next_number_; }
  /// Running numbers go on from `number` or beyond.
  void number_from(std::int64_t number);
  /// A sighting without an appearance leaves the last one.
  void record_sighting(std::size_t landmark,
                       std::shared_ptr<const Descriptor> appearance = nullptr);
  /// Counts one update of the filter; removes and returns the landmarks to give up.
  std::vector<BlockId> record_update();
  /// Removes and returns all landmarks.
  std::vector<BlockId> clear();
  /// Removes and returns those added less than so many updates ago. The others keep their places.
  std::vector<BlockId> clear_younger(int updates);

 private:
  bool given_up(const RegisteredLandmark& landmark) const;
  template <class Condition>
  std::vector<BlockId> clear_if(Condition condition);

  int confirm_after_, prune_after_, forget_after_;
  std::int64_t next_number_;
  std::vector<RegisteredLandmark> landmarks_;
  std::map<std::int64_t, std::size_t> by_id_;  // identities of the log and running numbers
};

}  // namespace libslam
