#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/system/string_utils.h>

#include <libslam/io/input_error.hpp>
#include <libslam/io/map_encoding.hpp>
#include <libslam/modules/simple_map_carrier.hpp>
#include <libslam/pipeline/pipeline.hpp>

namespace libslam {

namespace {

using mrpt::maps::CSimpleMap;
using mrpt::obs::CObservation;
using mrpt::obs::CObservationComment;
using mrpt::obs::CSensoryFrame;

/// What the text begins with; MRPT does not store the label of a comment.
constexpr std::string_view kPrefix = "libslam map, base64:\n";

bool is_map(const CObservation::Ptr& observation) {
  const auto comment = std::dynamic_pointer_cast<CObservationComment>(observation);
  return comment && comment->text.starts_with(kPrefix);
}

/// Noise and calibration have no say where poses are exact.
void make_exact(Parameters& p) {
  p.motion = {};
  p.motion.noise = {};
  p.motion.noise.from_log = false;
  p.motion.noise.along_per_sqrt_m = p.motion.noise.across_per_sqrt_m = 0.0;
  p.motion.noise.turn_per_sqrt_m = p.motion.noise.turn_per_sqrt_rad = 0.0;
  p.calibration = {};
  p.policies = {};
  p.map = {};
  p.input.odometry = "increments";
  p.filter.linearization = "estimate";
  p.filter.initial_sigma_xy = p.filter.initial_sigma_heading_deg = 0.0;
}

LogStep step_to(const mrpt::poses::CPose2D& moved, const CSensoryFrame::Ptr& frame) {
  mrpt::obs::CActionRobotMovement2D movement;
  movement.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(moved, mrpt::math::CMatrixDouble33());
  LogStep step;
  step.action = mrpt::obs::CActionCollection::Create();
  step.action->insert(movement);
  step.frame = frame;
  return step;
}

}  // namespace

void attach_map(const SavedMap& map, CSimpleMap& key_frames) {
  const std::string bytes = encode_map(map);
  auto comment = CObservationComment::Create();
  mrpt::system::encodeBase64(std::vector<std::uint8_t>(bytes.begin(), bytes.end()), comment->text);
  comment->text.insert(0, kPrefix);
  auto& last = key_frames.getAsPair(key_frames.size() - 1);
  last.sf = CSensoryFrame::Create(*last.sf);  // the frame is shared, its list of observations not
  last.sf->insert(comment);
}

std::optional<SavedMap> attached_map(const CSimpleMap& key_frames) {
  for (std::size_t i = key_frames.size(); i-- > 0;)
    for (const CObservation::Ptr& observation : *key_frames.getAsPair(i).sf) {
      if (!is_map(observation)) continue;
      const std::string name = "simple map: the landmark map in frame " + std::to_string(i);
      const auto& comment = dynamic_cast<const CObservationComment&>(*observation);
      std::vector<std::uint8_t> bytes;
      if (!mrpt::system::decodeBase64(comment.text.substr(kPrefix.size()), bytes))
        throw InputError(name + " is damaged");
      return decode_map({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name);
    }
  return std::nullopt;
}

CSensoryFrame::Ptr without_map(const CSensoryFrame::Ptr& frame) {
  if (std::none_of(frame->begin(), frame->end(), is_map)) return frame;
  auto rest = CSensoryFrame::Create();
  for (const CObservation::Ptr& observation : *frame)
    if (!is_map(observation)) rest->insert(observation);
  return rest;
}

SavedMap map_of_frames(const CSimpleMap& key_frames, Parameters parameters) {
  make_exact(parameters);
  Pipeline pipeline(parameters);
  mrpt::poses::CPose2D reached;  // the filter starts at the origin of the map
  for (const auto& [pose, frame] : key_frames) {
    const mrpt::poses::CPose2D mean(pose->getMeanVal());
    pipeline.process(step_to(mean - reached, frame));
    reached = mean;
  }
  return pipeline.filter().saved_map();
}

}  // namespace libslam
