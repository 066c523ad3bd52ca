#pragma once
// What RangeBearingSlam2D holds; not for users.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <libslam/io/pair_assembler.hpp>
#include <libslam/modules/range_bearing_slam_2d.hpp>
#include <libslam/pipeline/pipeline.hpp>

namespace libslam {

struct RangeBearingSlam2D::Impl {
  explicit Impl(const Parameters& parameters)
      : intake("processActionObservation", parameters.input.policy),
        assembler(intake),
        pipeline(parameters) {}

  const EkfSlam& filter() const { return pipeline.filter(); }
  Eigen::Vector3d pose() const { return filter().state().estimate(filter().pose()); }
  Eigen::Matrix3d cov_pose() const { return filter().state().covariance_of(filter().pose()); }

  /// The pair as a step with a time that can be trusted; both null: an empty step.
  LogStep assemble(const mrpt::obs::CActionCollection::Ptr& action,
                   const mrpt::obs::CSensoryFrame::Ptr& frame) {
    if (action) assembler.add_action(action, steps);
    if (frame)
      assembler.add_frame(frame, steps);
    else
      assembler.finish();
    LogStep step;
    if (!assembler.ready().empty()) step = std::move(assembler.ready().front());
    assembler.ready().clear();
    step.index = steps++;
    return step;
  }

  Intake intake;
  PairAssembler assembler;
  Pipeline pipeline;
  std::int64_t steps = 0;
  std::vector<Eigen::Vector2d> path;  ///< of options.create_simplemap
  std::size_t warnings_logged = 0;
  bool healthy = true;
};

}  // namespace libslam
