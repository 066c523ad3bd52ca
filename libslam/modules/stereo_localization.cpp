#include <optional>
#include <stdexcept>
#include <utility>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/poses/CPose3DPDF.h>

#include <libslam/config/validation.hpp>
#include <libslam/io/map_file.hpp>
#include <libslam/io/mrpt_fields.hpp>
#include <libslam/modules/pose_pdf.hpp>
#include <libslam/modules/start_pose.hpp>
#include <libslam/modules/stereo_localization.hpp>
#include <libslam/modules/stereo_localization_impl.hpp>
#include <libslam/pipeline/factory.hpp>

namespace libslam {

namespace {

using mrpt::obs::CActionCollection;
using mrpt::obs::CObservation;
using mrpt::obs::CObservationIMU;
using mrpt::obs::CObservationOdometry;
using mrpt::obs::CSensoryFrame;

/// Images may wait for the odometry after them, but not without end.
constexpr std::uint64_t kBytesPerImage = ObservationSplitter::kMaxPendingBytes / 64;

bool is_spatial(const Parameters& p) {
  return make_motion_model(p.motion, p.calibration, p.input)->pose_spec().chart == Chart::kSE3;
}

OdometryReading reading_of(const CObservationOdometry& odometry, double time) {
  OdometryReading reading;
  reading.time = time;
  reading.pose = {odometry.odometry.x(), odometry.odometry.y(), odometry.odometry.phi()};
  if (odometry.hasVelocities)
    reading.velocity = {odometry.velocityLocal.vx, odometry.velocityLocal.vy,
                        odometry.velocityLocal.omega};
  return reading;
}

}  // namespace

StereoLocalization::StereoLocalization() : COutputLogger("StereoLocalization") {}

StereoLocalization::~StereoLocalization() = default;

StereoLocalization::Impl& StereoLocalization::running() const {
  if (!impl_) throw std::logic_error("StereoLocalization: initialize() was not called");
  return *impl_;
}

void StereoLocalization::initialize(const mrpt::poses::CPose3DPDF* x0) {
  Parameters p = options.parameters;
  FilterStart start;
  if (x0 != nullptr) {
    StepRecord record;
    record.spatial = from_pose_pdf(*x0);
    record.pose = shadow_of(record.spatial->pose);
    record.cov = shadow_covariance(*record.spatial);
    start = start_at(record, is_spatial(p));
    p.map.start = "given_pose";
  }
  validate(p);
  impl_ = std::make_unique<Impl>(p, std::move(start));
}

void StereoLocalization::processObservation(const CObservation::Ptr& observation) {
  Impl& impl = running();
  const bool moves = std::dynamic_pointer_cast<CObservationIMU>(observation) ||
                     std::dynamic_pointer_cast<CObservationOdometry>(observation);
  const bool by_twist = impl.odometry == "twist", by_poses = !by_twist && impl.odometry != "none";
  if (moves && by_twist) return hold(*observation);
  if (moves || by_poses) {
    if (by_poses) drive(observation);
    return;
  }
  auto frame = CSensoryFrame::Create();
  frame->insert(observation);
  process(impl.twist.known() ? impl.twist.action(observation->timestamp) : nullptr, frame);
}

void StereoLocalization::hold(const CObservation& reading) {
  VehicleTwist& twist = running().twist;
  const bool first = !twist.known();
  if (!first) process(twist.action(reading.timestamp), nullptr);
  if (const auto* imu = dynamic_cast<const CObservationIMU*>(&reading)) twist.read(*imu);
  if (const auto* odometry = dynamic_cast<const CObservationOdometry*>(&reading))
    twist.read(*odometry);
  // The first reading starts the clock; it also holds for what was before it.
  if (first && twist.known()) process(twist.action(reading.timestamp), nullptr);
}

void StereoLocalization::drive(const CObservation::Ptr& observation) {
  ObservationSplitter& splitter = running().splitter;
  const auto* odometry = dynamic_cast<const CObservationOdometry*>(observation.get());
  const std::optional<double> time = stamp_seconds(observation->timestamp);
  const double earliest = odometry ? splitter.last_reading_time() : splitter.open_time();
  if (!time || *time < earliest) {
    MRPT_LOG_WARN_STREAM("observation '" << observation->sensorLabel
                                         << "' has no valid time or comes too late: left out");
    return;
  }
  if (odometry)
    splitter.add_reading(reading_of(*odometry, *time));
  else if (!std::dynamic_pointer_cast<CObservationIMU>(observation))
    splitter.add_observation(observation, *time, kBytesPerImage);
  process_ready();
}

void StereoLocalization::process_ready() {
  Impl& impl = running();
  while (!impl.splitter.ready().empty()) {
    LogStep step = std::move(impl.splitter.ready().front());
    impl.splitter.ready().pop_front();
    impl.feed.process(std::move(step));
    impl.feed.report(*this);
  }
}

void StereoLocalization::processActionObservation(const CActionCollection::Ptr& action,
                                                  const CSensoryFrame::Ptr& SF) {
  process(action ? CActionCollection::Create(*action) : nullptr, SF);  // it is mended on its way
}

void StereoLocalization::process(const CActionCollection::Ptr& action,
                                 const CSensoryFrame::Ptr& frame) {
  Impl& impl = running();
  try {
    impl.feed.process(action, frame);
  } catch (const UnusableOdometry& unusable) {
    if (options.parameters.input.policy == "strict") throw;
    MRPT_LOG_WARN(unusable.what());
    impl.feed.process_without_odometry();
  }
  impl.feed.report(*this);
}

void StereoLocalization::getCurrentPose(mrpt::poses::CPose3DPDFGaussian& out_pose) const {
  out_pose = to_pose_pdf(running().feed.last());
}

void StereoLocalization::getCurrentPose(mrpt::poses::CPose3DQuatPDFGaussian& out_pose) const {
  out_pose = to_quaternion_pdf(running().feed.last());
}

const StepRecord& StereoLocalization::getLastStep() const {
  return running().feed.last();
}

std::vector<LandmarkEstimate> StereoLocalization::getLandmarks() const {
  return running().feed.filter().landmarks();
}

void StereoLocalization::saveMap(const std::string& file) const {
  write_map_file(file, running().feed.filter().saved_map());
}

void StereoLocalization::saveState(mrpt::serialization::CArchive& out) const {
  write_state(out, running().feed.state());
}

void StereoLocalization::loadState(mrpt::serialization::CArchive& in) {
  Parameters p = options.parameters;
  validate(p);
  impl_ = std::make_unique<Impl>(p, read_state(in));
}

}  // namespace libslam
