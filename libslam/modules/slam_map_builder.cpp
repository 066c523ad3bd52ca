#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/serialization/CArchive.h>

#include <libslam/config/config_error.hpp>
#include <libslam/config/validation.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/modules/pose_pdf.hpp>
#include <libslam/modules/simple_map_carrier.hpp>
#include <libslam/modules/slam_map_builder.hpp>
#include <libslam/modules/slam_map_builder_impl.hpp>
#include <libslam/modules/start_pose.hpp>
#include <libslam/pipeline/factory.hpp>

namespace libslam {

SlamMapBuilder::SlamMapBuilder() {
  setLoggerName("SlamMapBuilder");
  start({}, nullptr);
  impl_->fresh = true;
}

SlamMapBuilder::~SlamMapBuilder() = default;

void SlamMapBuilder::initialize(const mrpt::maps::CSimpleMap& initialMap,
                                const mrpt::poses::CPosePDF* x0) {
  const std::lock_guard lock(critical_);
  start(initialMap, x0);
}

void SlamMapBuilder::start(const mrpt::maps::CSimpleMap& map, const mrpt::poses::CPosePDF* x0) {
  const Parameters& p = slam_options.parameters;
  validate(p);
  if (p.measurement.model == "sensor_displacement")
    throw ConfigError("measurement.model: a map builder needs landmarks, not displacements");
  const bool spatial =
      make_motion_model(p.motion, p.calibration, p.input)->pose_spec().chart == Chart::kSE3;
  FilterStart start;
  if (x0 != nullptr)
    start = start_at(*x0, spatial);
  else if (impl_ && !impl_->fresh)
    start = start_at(impl_->feed.last(), spatial);
  std::optional<SavedMap> landmarks = attached_map(map);
  if (!landmarks && !map.empty() && !spatial) landmarks = map_of_frames(map, p);
  if (landmarks) {
    start.map.emplace().map = std::make_shared<const SavedMap>(std::move(*landmarks));
    start.map->at_saved_pose = false;
  }
  auto fresh = std::make_unique<Impl>(slam_options, std::move(start));
  fresh->maps.insert(map);
  fresh->landmarks_shown = false;
  impl_ = std::move(fresh);
}

void SlamMapBuilder::processActionObservation(mrpt::obs::CActionCollection& action,
                                              mrpt::obs::CSensoryFrame& observations) {
  // Actions are mended on their way, observations are shared with the key frames.
  const auto own_action = mrpt::obs::CActionCollection::Create(action);
  const auto own_frame = mrpt::obs::CSensoryFrame::Create(observations);
  const std::lock_guard lock(critical_);
  if (impl_->fresh) start({}, nullptr);  // with the options as they are now
  hold_map_on_demand();
  process(own_action, own_frame);
}

void SlamMapBuilder::hold_map_on_demand() {
  const bool given = !options.enableMapUpdating || PairFeed::localizes(slam_options.parameters);
  if (std::exchange(impl_->map_given, given) != given) impl_->feed.give_landmarks(given);
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
  impl_->feed.report(*this);
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

mrpt::poses::CPose3DPDF::Ptr SlamMapBuilder::getCurrentPoseEstimation() const {
  const std::lock_guard lock(critical_);
  return mrpt::poses::CPose3DPDFGaussian::Create(to_pose_pdf(impl_->feed.last()));
}

void SlamMapBuilder::getCurrentlyBuiltMap(mrpt::maps::CSimpleMap& out_map) const {
  const std::lock_guard lock(critical_);
  out_map = impl_->maps.key_frames();
  const EkfSlam& filter = impl_->feed.filter();
  if (!out_map.empty() && filter.registry().size() > 0 && filter.healthy())
    attach_map(filter.saved_map(), out_map);
}

void SlamMapBuilder::saveState(mrpt::serialization::CArchive& out) const {
  const std::lock_guard lock(critical_);
  write_state(out, impl_->feed.state());
  out << impl_->maps.key_frames();
}

void SlamMapBuilder::loadState(mrpt::serialization::CArchive& in) {
  const std::lock_guard lock(critical_);
  ModuleState state = read_state(in);
  mrpt::maps::CSimpleMap key_frames;
  try {
    in >> key_frames;
  } catch (const std::exception&) {  // MRPT's own has a page of text
    throw InputError("saved state: its key frames cannot be read");
  }
  validate(slam_options.parameters);
  auto loaded = std::make_unique<Impl>(slam_options, std::move(state));
  loaded->maps.insert(key_frames);
  loaded->landmarks_shown = false;
  impl_ = std::move(loaded);
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

std::vector<AdaptedNoise> SlamMapBuilder::getCurrentNoise() const {
  const std::lock_guard lock(critical_);
  return impl_->feed.last().noise;
}

std::string SlamMapBuilder::getLastEvent() const {
  const std::lock_guard lock(critical_);
  return impl_->feed.last().event;
}

std::vector<CalibrationValue> SlamMapBuilder::getCurrentCalibration() const {
  const std::lock_guard lock(critical_);
  return impl_->feed.filter().calibration();
}

}  // namespace libslam
