#include <limits>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/bayes/CKalmanFilterCapable.h>
#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/data_association.h>

#include <libslam/modules/range_bearing_slam_2d.hpp>
#include <libslam/modules/range_bearing_slam_2d_impl.hpp>

namespace libslam {

namespace {

/// Identities of CObservationBearingRange have 32 bits; numbers beyond were given by the filter.
bool is_from_log(std::int64_t id) {
  return id <= std::numeric_limits<std::int32_t>::max();
}

/// Coordinates of pose and landmarks in the state: all but the calibration.
std::vector<Eigen::Index> mapping_coordinates(const EkfSlam& filter) {
  std::vector<Eigen::Index> coordinates;
  const auto append = [&](BlockId block) {
    for (Eigen::Index i = 0; i < filter.state().size(block); ++i)
      coordinates.push_back(filter.state().offset(block) + i);
  };
  append(filter.pose());
  for (const RegisteredLandmark& landmark : filter.registry().landmarks()) append(landmark.block);
  return coordinates;
}

}  // namespace

RangeBearingSlam2D::RangeBearingSlam2D() : COutputLogger("RangeBearingSlam2D") {
  start();
}

RangeBearingSlam2D::~RangeBearingSlam2D() = default;

void RangeBearingSlam2D::reset() {
  start();
}

void RangeBearingSlam2D::start() {
  impl_ = std::make_unique<Impl>(options.getEffectiveParameters());
  association_ = {};
}

void RangeBearingSlam2D::processActionObservation(
    std::shared_ptr<mrpt::obs::CActionCollection>& action,
    std::shared_ptr<mrpt::obs::CSensoryFrame>& SF) {
  if (impl_->feed.steps() == 0) {
    start();  // with the options as they are now
    warn_about_options();
  }
  const std::size_t known_landmarks = impl_->filter().registry().size();
  impl_->feed.process(action, SF);
  association_ = {};
  for (std::size_t i = 0; i < known_landmarks; ++i) association_.predictions_IDs.push_back(i);
  report_step();
}

void RangeBearingSlam2D::report_step() {
  Impl& impl = *impl_;
  const UpdateOutcome& outcome = impl.feed.pipeline().last_update();
  for (std::size_t i = 0; i < outcome.verdicts.size(); ++i) {
    const Verdict& verdict = outcome.verdicts[i];
    if (verdict.outcome == Outcome::kPaired)
      association_.results.associations[i] = verdict.landmark;
    if (verdict.outcome == Outcome::kNew)
      association_.newly_inserted_landmarks[i] = verdict.landmark;
  }
  association_.results.distance = outcome.nis;
  if (options.create_simplemap) impl.path.emplace_back(impl.pose().head<2>());
  impl.feed.report(*this);
}

void RangeBearingSlam2D::warn_about_options() const {
  if (KF_options.method != mrpt::bayes::kfEKFNaive)
    MRPT_LOG_WARN("KF_options.method: only kfEKFNaive is available, which runs now");
  if (options.data_assoc_method != mrpt::slam::assocNN)
    MRPT_LOG_WARN("data_assoc_method: only assocNN is available, which runs now");
  if (options.data_assoc_IC_metric != mrpt::slam::metricMaha)
    MRPT_LOG_WARN("data_assoc_IC_metric: only metricMaha is available, which runs now");
}

void RangeBearingSlam2D::getCurrentRobotPose(mrpt::poses::CPosePDFGaussian& out_robotPose) const {
  const Eigen::Vector3d pose = impl_->pose();
  out_robotPose.mean = mrpt::poses::CPose2D(pose[0], pose[1], pose[2]);
  out_robotPose.cov.asEigen() = impl_->cov_pose();
}

void RangeBearingSlam2D::getCurrentState(mrpt::poses::CPosePDFGaussian& out_robotPose,
                                         std::vector<mrpt::math::TPoint2D>& out_landmarksPositions,
                                         std::map<unsigned int, std::int64_t>& out_landmarkIDs,
                                         mrpt::math::CVectorDouble& out_fullState,
                                         mrpt::math::CMatrixDouble& out_fullCovariance) const {
  const EkfSlam& filter = impl_->filter();
  const auto landmarks = filter.registry().landmarks();
  const std::size_t size = 3 + 2 * landmarks.size();
  getCurrentRobotPose(out_robotPose);
  out_landmarksPositions.clear();
  out_landmarkIDs.clear();
  Eigen::VectorXd mean(static_cast<Eigen::Index>(size));
  mean.head<3>() = impl_->pose();
  unsigned int position = 0;
  for (const RegisteredLandmark& landmark : landmarks) {
    const Eigen::Vector2d point = filter.state().estimate(landmark.block);
    mean.segment<2>(3 + 2 * position) = point;
    out_landmarksPositions.emplace_back(point.x(), point.y());
    out_landmarkIDs[position] = is_from_log(landmark.id) ? landmark.id : position;
    ++position;
  }
  const auto coordinates = mapping_coordinates(filter);
  out_fullState.resize(size);
  out_fullState.asEigen() = mean;
  out_fullCovariance.setSize(size, size);
  out_fullCovariance.asEigen() = filter.state().full_covariance()(coordinates, coordinates);
}

void RangeBearingSlam2D::saveState(mrpt::serialization::CArchive& out) const {
  write_state(out, impl_->feed.state());
}

void RangeBearingSlam2D::loadState(mrpt::serialization::CArchive& in) {
  impl_ = std::make_unique<Impl>(options.getEffectiveParameters(), read_state(in));
  association_ = {};
}

std::vector<AdaptedNoise> RangeBearingSlam2D::getCurrentNoise() const {
  return impl_->feed.last().noise;
}

std::string RangeBearingSlam2D::getLastEvent() const {
  return impl_->feed.last().event;
}

std::vector<CalibrationValue> RangeBearingSlam2D::getCurrentCalibration() const {
  return impl_->filter().calibration();
}

}  // namespace libslam
