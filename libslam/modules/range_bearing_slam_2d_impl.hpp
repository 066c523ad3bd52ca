#pragma once
// What RangeBearingSlam2D holds; not for users.

#include <utility>
#include <vector>

#include <Eigen/Core>

#include <libslam/modules/pair_feed.hpp>
#include <libslam/modules/range_bearing_slam_2d.hpp>

namespace libslam {

struct RangeBearingSlam2D::Impl {
  explicit Impl(const Parameters& parameters) : feed(parameters, kEntryPoint) {}
  Impl(const Parameters& parameters, ModuleState state)
      : feed(parameters, kEntryPoint, std::move(state)) {}
  static constexpr const char* kEntryPoint = "processActionObservation";

  const EkfSlam& filter() const { return feed.filter(); }
  Eigen::Vector3d pose() const { return filter().state().estimate(filter().pose()); }
  Eigen::Matrix3d cov_pose() const { return filter().state().covariance_of(filter().pose()); }

  PairFeed feed;
  std::vector<Eigen::Vector2d> path;  ///< of options.create_simplemap
};

}  // namespace libslam
