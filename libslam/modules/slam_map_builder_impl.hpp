#pragma once
// What SlamMapBuilder holds; not for users.

#include <utility>

#include <libslam/modules/key_frame_map.hpp>
#include <libslam/modules/pair_feed.hpp>
#include <libslam/modules/slam_map_builder.hpp>

namespace libslam {

struct SlamMapBuilder::Impl {
  /// `start`: a FilterStart or a ModuleState.
  template <typename Start>
  Impl(const TConfigParams& options, Start start)
      : feed(options.parameters, "processActionObservation", std::move(start)),
        maps(options.mapInitializers) {}

  PairFeed feed;
  KeyFrameMap maps;
  bool landmarks_shown = true;  ///< `maps` shows them as they are now
  bool fresh = false;           ///< never initialized: options may still change
  bool map_given = false;       ///< the filter localizes
};

}  // namespace libslam
