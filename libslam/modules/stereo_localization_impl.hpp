#pragma once
// What StereoLocalization holds; not for users.

#include <string>
#include <utility>

#include <libslam/io/observation_splitter.hpp>
#include <libslam/modules/pair_feed.hpp>
#include <libslam/modules/stereo_localization.hpp>
#include <libslam/modules/vehicle_twist.hpp>

namespace libslam {

struct StereoLocalization::Impl {
  /// `start`: a FilterStart or a ModuleState.
  template <typename Start>
  Impl(const Parameters& parameters, Start start)
      : feed(parameters, "processObservation", std::move(start)),
        odometry(parameters.input.odometry) {}

  PairFeed feed;
  std::string odometry;          ///< input.odometry: what drives the motion
  VehicleTwist twist;            ///< where velocities do
  ObservationSplitter splitter;  ///< where poses of odometry do
};

}  // namespace libslam
