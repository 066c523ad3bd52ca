#pragma once
// Where a module starts, in the terms of its filter.

#include <libslam/data/step_record.hpp>
#include <libslam/pipeline/pipeline.hpp>

namespace mrpt::poses {
class CPosePDF;
}

namespace libslam {

/// The pose of `record` in space; a planar one lies on the ground.
SpatialEstimate spatial_estimate(const StepRecord& record);

/// The pose of `record` and its covariance as the start of a filter. A filter in space (`spatial`)
/// takes a planar pose as one on the ground, upright; a planar filter takes the shadow of another.
FilterStart start_at(const StepRecord& record, bool spatial);
FilterStart start_at(const mrpt::poses::CPosePDF& pose, bool spatial);

}  // namespace libslam
