#pragma once
// What a front-end saw in the images of a frame, as a picture for the report.

#include <optional>
#include <span>

#include <mrpt/obs/CSensoryFrame.h>

#include <libslam/frontend/frontend.hpp>
#include <libslam/result/report_picture.hpp>

namespace libslam {

/// `batches`: what the front-end made of `frame`. Nothing where it holds no stereo images.
std::optional<ReportPicture> draw_frame(const mrpt::obs::CSensoryFrame& frame,
                                        std::span<const FeatureBatch> batches);

}  // namespace libslam
