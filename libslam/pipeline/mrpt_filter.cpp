#include <map>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>

#include <libslam/frontend/odometry.hpp>
#include <libslam/pipeline/factory.hpp>
#include <libslam/pipeline/mrpt_filter.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

namespace {

using mrpt::obs::CObservationBearingRange;

CalibrationParameters constants_of(CalibrationParameters calibration) {
  for (CalibrationParameter* parameter :
       {&calibration.scale_left, &calibration.scale_right, &calibration.track_width,
        &calibration.scale_speed, &calibration.scale_steering, &calibration.bias_steering,
        &calibration.scale_turn, &calibration.bias_turn})
    parameter->enabled = false;
  return calibration;
}

/// A pose and its covariance, moved by our motion model.
class MovedPose {
 public:
  explicit MovedPose(const Parameters& parameters)
      : model_(make_motion_model(parameters.motion, constants_of(parameters.calibration),
                                 parameters.input)),
        pose_(state_.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, Eigen::Vector3d::Zero(),
                         Eigen::Matrix3d::Zero())) {}

  void set(const Eigen::Vector3d& mean, const Eigen::Matrix3d& cov) {
    state_.set_estimate(pose_, mean);
    cov_ = cov;
  }
  void add(const MotionAction& action) {
    model_->linearize(state_, pose_, {}, action, step_);
    const Eigen::Matrix3d f = step_.wrt.begin()->jacobian;
    cov_ = f * cov_ * f.transpose() + step_.cov_noise;
    state_.set_estimate(pose_, step_.estimate);
  }
  Eigen::Vector3d mean() const { return state_.estimate(pose_); }
  const Eigen::Matrix3d& cov() const { return cov_; }

 private:
  std::unique_ptr<MotionModel> model_;
  GaussianState state_;
  BlockId pose_;
  Eigen::Matrix3d cov_ = Eigen::Matrix3d::Zero();
  MotionStep step_;
};

mrpt::obs::CActionCollection::Ptr action_of(const MovedPose& motion) {
  mrpt::poses::CPosePDFGaussian change;
  const Eigen::Vector3d mean = motion.mean();
  change.mean = {mean[0], mean[1], mean[2]};
  change.cov = mrpt::math::CMatrixDouble33(motion.cov());
  mrpt::obs::CActionRobotMovement2D movement;
  movement.rawOdometryIncrementReading = change.mean;
  movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(change);
  auto actions = mrpt::obs::CActionCollection::Create();
  actions->insert(movement);
  return actions;
}

/// A frame with the sightings that the configuration lets through; null if there are none.
mrpt::obs::CSensoryFrame::Ptr usable_frame(const mrpt::obs::CSensoryFrame::Ptr& frame,
                                           const Parameters& parameters) {
  const auto seen = frame ? frame->getObservationByClass<CObservationBearingRange>() : nullptr;
  if (!seen) return nullptr;
  auto copy = std::make_shared<CObservationBearingRange>(*seen);
  std::erase_if(copy->sensedData, [&](const auto& m) {
    return m.range > parameters.frontend.max_range || m.range < parameters.frontend.min_range;
  });
  if (!parameters.association.uses_identities())
    for (auto& measured : copy->sensedData) measured.landmarkID = -1;
  if (copy->sensedData.empty()) return nullptr;
  auto out = mrpt::obs::CSensoryFrame::Create();
  out->insert(copy);
  return out;
}

}  // namespace

class MrptFilter::Impl {
 public:
  Impl(const Parameters& parameters, Method method)
      : parameters_(parameters),
        odometry_(parameters.input),
        since_update_(parameters),
        predicted_(parameters) {
    filter_.options.std_sensor_range = static_cast<float>(parameters.measurement.sigma_range);
    filter_.options.std_sensor_yaw =
        static_cast<float>(parameters.measurement.sigma_bearing_deg * kPi / 180.0);
    filter_.options.data_assoc_IC_chi2_thres = parameters.association.gate_probability;
    filter_.KF_options.method =
        method == Method::kDavison ? mrpt::bayes::kfEKFAlaDavison : mrpt::bayes::kfEKFNaive;
    filter_.setMinLoggingLevel(mrpt::system::LVL_ERROR);
  }

  std::optional<StepRecord> process(const LogStep& step) {
    if (step.action)
      if (const auto action = odometry_.read(step)) {
        since_update_.add(*action);
        predicted_.add(*action);
      }
    if (!step.frame) return std::nullopt;
    StepRecord record;
    record.index = step.index;
    record.time = step.time;
    if (auto frame = usable_frame(step.frame, parameters_)) record.accepted = update(frame);
    record.pose = predicted_.mean();
    record.cov = predicted_.cov();
    return record;
  }

  LandmarkMap landmarks() const {
    mrpt::poses::CPosePDFGaussian pose;
    std::vector<mrpt::math::TPoint2D> points;
    std::map<unsigned int, mrpt::maps::CLandmark::TLandmarkID> ids;
    mrpt::math::CVectorDouble state;
    mrpt::math::CMatrixDouble cov;
    filter_.getCurrentState(pose, points, ids, state, cov);
    LandmarkMap map;
    for (unsigned int i = 0; i < points.size(); ++i) {
      const Eigen::Matrix2d block = cov.asEigen().block<2, 2>(3 + 2 * i, 3 + 2 * i);
      const auto named = ids.find(i);
      const std::int64_t id =
          named == ids.end() ? std::int64_t{i} : static_cast<std::int64_t>(named->second);
      map.add({id, "point", Eigen::Vector2d(points[i].x, points[i].y), block, 1});
    }
    return map;
  }

 private:
  /// Returns the number of sightings.
  int update(mrpt::obs::CSensoryFrame::Ptr& frame) {
    auto actions = action_of(since_update_);
    const auto seen = frame->getObservationByClass<CObservationBearingRange>();
    const int sightings = static_cast<int>(seen->sensedData.size());
    filter_.processActionObservation(actions, frame);
    mrpt::poses::CPosePDFGaussian pose;
    filter_.getCurrentRobotPose(pose);
    since_update_.set(Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero());
    predicted_.set({pose.mean.x(), pose.mean.y(), pose.mean.phi()}, pose.cov.asEigen());
    return sightings;
  }

  Parameters parameters_;
  OdometryReader odometry_;
  MovedPose since_update_, predicted_;
  mrpt::slam::CRangeBearingKFSLAM2D filter_;
};

MrptFilter::MrptFilter(const Parameters& parameters, Method method)
    : impl_(std::make_unique<Impl>(parameters, method)) {}
MrptFilter::~MrptFilter() = default;

std::optional<StepRecord> MrptFilter::process(const LogStep& step) {
  return impl_->process(step);
}

LandmarkMap MrptFilter::landmarks() const {
  return impl_->landmarks();
}

}  // namespace libslam
