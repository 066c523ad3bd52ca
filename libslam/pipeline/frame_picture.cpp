#include <string>
#include <utility>

#include <libslam/frontend/match_drawing.hpp>
#include <libslam/pipeline/frame_picture.hpp>

namespace libslam {

std::optional<ReportPicture> draw_frame(const mrpt::obs::CSensoryFrame& frame,
                                        std::span<const FeatureBatch> batches) {
  const auto pair = frame.getObservationByClass<mrpt::obs::CObservationStereoImages>();
  if (!pair || batches.empty()) return std::nullopt;
  const std::vector<std::uint8_t> png = draw_matches(*pair, batches.front());
  if (png.empty()) return std::nullopt;
  return ReportPicture{std::to_string(batches.front().size()) +
                           " stereo points of the first pair that corrected the filter",
                       std::string(png.begin(), png.end())};
}

}  // namespace libslam
