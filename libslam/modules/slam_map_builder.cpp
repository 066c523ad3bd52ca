#include <algorithm>
#include <utility>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/poses/CPosePDFGaussian.h>

#include <libslam/config/config_error.hpp>
#include <libslam/config/validation.hpp>
#include <libslam/modules/pose_pdf.hpp>
#include <libslam/modules/slam_map_builder.hpp>
#include <libslam/modules/slam_map_builder_impl.hpp>

namespace libslam {

SlamMapBuilder::SlamMapBuilder() {
  setLoggerName("SlamMapBuilder");
  start({}, nullptr);
}

SlamMapBuilder::~SlamMapBuilder() = default;

void SlamMapBuilder::initialize(const mrpt::maps::CSimpleMap& initialMap,
                                const mrpt::poses::CPosePDF* x0) {
  const std::lock_guard lock(critical_);
  start(initialMap, x0);
}

void SlamMapBuilder::start(const mrpt::maps::CSimpleMap& map, const mrpt::poses::CPosePDF* x0) {
  validate(slam_options.parameters);
  (void)x0;
  impl_ = std::make_unique<Impl>(slam_options);
  impl_->maps.insert(map);
}

void SlamMapBuilder::processActionObservation(mrpt::obs::CActionCollection& action,
                                              mrpt::obs::CSensoryFrame& observations) {
  // Actions are mended on their way, observations are shared with the key frames.
  const auto own_action = mrpt::obs::CActionCollection::Create(action);
  const auto own_frame = mrpt::obs::CSensoryFrame::Create(observations);
  const std::lock_guard lock(critical_);
  if (impl_->feed.steps() == 0 && impl_->maps.key_frames().empty()) start({}, nullptr);
  process(own_action, own_frame);
}

void SlamMapBuilder::process(const mrpt::obs::CActionCollection::Ptr& action,
                             const mrpt::obs::CSensoryFrame::Ptr& frame) {
  try {
    impl_->feed.process(action, frame);
  } catch (const UnusableOdometry& unusable) {
    if (slam_options.parameters.input.policy == "strict") throw;
    MRPT_LOG_WARN(unusable.what());
    impl_->feed.process_without_odometry();
  }
  impl_->landmarks_shown = false;
  if (is_key_frame(*frame)) impl_->maps.insert(to_pose_pdf(impl_->feed.last()), frame);
  report_step();
}

bool SlamMapBuilder::is_key_frame(const mrpt::obs::CSensoryFrame& frame) const {
  if (!options.enableMapUpdating || frame.empty()) return false;
  if (options.debugForceInsertion) return true;
  if (std::any_of(frame.begin(), frame.end(), [&](const auto& observation) {
        return options.alwaysInsertByClass.contains(observation->GetRuntimeClass());
      }))
    return true;
  return impl_->maps.is_due(to_pose_pdf(impl_->feed.last()).mean,
                            {slam_options.insertionLinDistance, slam_options.insertionAngDistance});
}

void SlamMapBuilder::report_step() {
  const StepRecord& record = impl_->feed.last();
  MRPT_LOG_DEBUG_STREAM("step " << record.index << ": " << record.accepted << " sightings, "
                                << record.new_landmarks << " new landmarks, "
                                << record.gated + record.ambiguous << " not used");
  for (const std::string& warning : impl_->feed.take_warnings()) MRPT_LOG_WARN(warning);
  if (std::exchange(impl_->healthy, impl_->feed.filter().healthy()) && !impl_->healthy)
    MRPT_LOG_ERROR_STREAM("the filter diverged at step " << record.index);
}

mrpt::poses::CPose3DPDF::Ptr SlamMapBuilder::getCurrentPoseEstimation() const {
  const std::lock_guard lock(critical_);
  return mrpt::poses::CPose3DPDFGaussian::Create(to_pose_pdf(impl_->feed.last()));
}

void SlamMapBuilder::getCurrentlyBuiltMap(mrpt::maps::CSimpleMap& out_map) const {
  const std::lock_guard lock(critical_);
  out_map = impl_->maps.key_frames();
}

unsigned int SlamMapBuilder::getCurrentlyBuiltMapSize() {
  const std::lock_guard lock(critical_);
  return static_cast<unsigned int>(impl_->maps.key_frames().size());
}

const mrpt::maps::CMultiMetricMap* SlamMapBuilder::getCurrentlyBuiltMetricMap() const {
  const std::lock_guard lock(critical_);
  if (!std::exchange(impl_->landmarks_shown, true))
    impl_->maps.show(impl_->feed.filter().landmarks());
  return &impl_->maps.metric_map();
}

std::vector<CalibrationValue> SlamMapBuilder::getCurrentCalibration() const {
  const std::lock_guard lock(critical_);
  return impl_->feed.filter().calibration();
}

}  // namespace libslam
