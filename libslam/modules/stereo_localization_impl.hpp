#pragma once
// What StereoLocalization holds; not for users.

#include <optional>
#include <utility>

#include <Eigen/Core>

#include <libslam/io/observation_splitter.hpp>
#include <libslam/modules/pair_feed.hpp>
#include <libslam/modules/stereo_localization.hpp>

namespace libslam {

struct StereoLocalization::Impl {
  /// `start`: a FilterStart or a ModuleState.
  template <typename Start>
  Impl(const Parameters& parameters, Start start)
      : feed(parameters, "processObservation", std::move(start)),
        odometry(parameters.input.odometry) {}

  PairFeed feed;
  std::string odometry;  ///< input.odometry: what drives the motion
  /// Velocity of the vehicle that holds now: vx, vy, vz [m/s], wx, wy, wz [rad/s].
  std::optional<Eigen::Matrix<double, 6, 1>> twist;
  ObservationSplitter splitter;  ///< of planar odometry
  std::size_t ignored = 0;       ///< observations that nothing could be made of
  bool healthy = true;
};

}  // namespace libslam
