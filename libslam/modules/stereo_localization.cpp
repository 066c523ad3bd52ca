#include <stdexcept>
#include <utility>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
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

using Twist = Eigen::Matrix<double, 6, 1>;
using mrpt::obs::CActionCollection;
using mrpt::obs::CObservationIMU;
using mrpt::obs::CSensoryFrame;

bool is_spatial(const Parameters& p) {
  return make_motion_model(p.motion, p.calibration, p.input)->pose_spec().chart == Chart::kSE3;
}

/// The start that the parameters describe.
StepRecord configured_start(const Parameters& p) {
  StepRecord record;
  const double heading = p.map.initial_heading_deg * kPi / 180.0;
  const double sigma_heading = p.filter.initial_sigma_heading_deg * kPi / 180.0;
  record.pose = {p.map.initial_x, p.map.initial_y, heading};
  record.cov.diagonal() << std::pow(p.filter.initial_sigma_xy, 2),
      std::pow(p.filter.initial_sigma_xy, 2), std::pow(sigma_heading, 2);
  return record;
}

std::optional<Twist> twist_of(const CObservationIMU& imu) {
  constexpr mrpt::obs::TIMUDataIndex kFields[] = {mrpt::obs::IMU_X_VEL, mrpt::obs::IMU_Y_VEL,
                                                  mrpt::obs::IMU_Z_VEL, mrpt::obs::IMU_WX,
                                                  mrpt::obs::IMU_WY,    mrpt::obs::IMU_WZ};
  Twist twist;
  for (int i = 0; i < 6; ++i) {
    if (!imu.has(kFields[i])) return std::nullopt;
    twist[i] = imu.get(kFields[i]);
  }
  return twist;
}

/// The velocity as an action, which ends at `time`.
CActionCollection::Ptr action_of(const Twist& twist, const mrpt::Clock::time_point& time) {
  mrpt::obs::CActionRobotMovement3D movement;
  movement.timestamp = time;
  movement.hasVelocities.assign(6, true);
  movement.velocities.resize(6);  // x, y, z, yaw, pitch, roll
  const double values[] = {twist[0], twist[1], twist[2], twist[5], twist[4], twist[3]};
  for (int i = 0; i < 6; ++i) movement.velocities[i] = values[i];
  auto actions = CActionCollection::Create();
  actions->insert(movement);
  return actions;
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
  validate(p);
  FilterStart start;
  if (x0 != nullptr) {
    p.map.start = "given_pose";
    start = start_at(*x0, is_spatial(p));
  } else if (p.map.file.empty() || p.map.start == "given_pose") {
    start = start_at(configured_start(p), is_spatial(p));
  }
  impl_ = std::make_unique<Impl>(p, std::move(start));
}

void StereoLocalization::processObservation(const mrpt::obs::CObservation::Ptr& observation) {
  Impl& impl = running();
  if (const auto imu = std::dynamic_pointer_cast<CObservationIMU>(observation)) {
    const std::optional<Twist> read = twist_of(*imu);
    if (!read) return;
    if (impl.twist) processActionObservation(action_of(*impl.twist, imu->timestamp), nullptr);
    impl.twist = read;
    return;
  }
  auto frame = CSensoryFrame::Create();
  frame->insert(observation);
  processActionObservation(impl.twist ? action_of(*impl.twist, observation->timestamp) : nullptr,
                           frame);
}

void StereoLocalization::processActionObservation(const CActionCollection::Ptr& action,
                                                  const CSensoryFrame::Ptr& SF) {
  Impl& impl = running();
  try {
    impl.feed.process(action, SF);
  } catch (const UnusableOdometry& unusable) {
    if (options.parameters.input.policy == "strict") throw;
    MRPT_LOG_WARN(unusable.what());
    impl.feed.process_without_odometry();
  }
  report_step();
}

void StereoLocalization::report_step() {
  Impl& impl = running();
  const StepRecord& record = impl.feed.last();
  MRPT_LOG_DEBUG_STREAM("step " << record.index << ": " << record.accepted << " points, "
                                << record.new_landmarks << " new landmarks, "
                                << record.gated + record.ambiguous << " not used");
  for (const std::string& warning : impl.feed.take_warnings()) MRPT_LOG_WARN(warning);
  if (std::exchange(impl.healthy, impl.feed.filter().healthy()) && !impl.healthy)
    MRPT_LOG_ERROR_STREAM("the filter diverged at step " << record.index);
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
