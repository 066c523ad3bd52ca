#pragma once
// What SlamMapBuilder holds; not for users.

#include <libslam/modules/key_frame_map.hpp>
#include <libslam/modules/pair_feed.hpp>
#include <libslam/modules/slam_map_builder.hpp>

namespace libslam {

struct SlamMapBuilder::Impl {
  explicit Impl(const TConfigParams& options)
      : feed(options.parameters, "processActionObservation"), maps(options.mapInitializers) {}

  PairFeed feed;
  KeyFrameMap maps;
  bool landmarks_shown = true;  ///< `maps` shows them as they are now
  bool healthy = true;
};

}  // namespace libslam
