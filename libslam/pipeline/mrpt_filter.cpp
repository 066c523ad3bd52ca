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

/// The motion since the last frame, with the covariance of our motion model.
class AccumulatedMotion {
 public:
  explicit AccumulatedMotion(const Parameters& parameters)
      : model_(make_motion_model(parameters.motion, {}, parameters.input)),
        pose_(state_.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, Eigen::Vector3d::Zero(),
                         Eigen::Matrix3d::Zero())) {}

  void add(const MotionAction& action) {
    model_->linearize(state_, pose_, {}, action, step_);
    const Eigen::Matrix3d f = step_.wrt.begin()->jacobian;
    cov_ = f * cov_ * f.transpose() + step_.cov_noise;
    state_.set_estimate(pose_, step_.estimate);
  }

  mrpt::obs::CActionCollection::Ptr take() {
    mrpt::poses::CPosePDFGaussian change;
    const auto mean = state_.estimate(pose_);
    change.mean = {mean[0], mean[1], mean[2]};
    change.cov = mrpt::math::CMatrixDouble33(cov_);
    mrpt::obs::CActionRobotMovement2D movement;
    movement.rawOdometryIncrementReading = change.mean;
    movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(change);
    auto actions = mrpt::obs::CActionCollection::Create();
    actions->insert(movement);
    state_.set_estimate(pose_, Eigen::Vector3d::Zero());
    cov_.setZero();
    return actions;
  }

 private:
  std::unique_ptr<MotionModel> model_;
  GaussianState state_;
  BlockId pose_;
  Eigen::Matrix3d cov_ = Eigen::Matrix3d::Zero();
  MotionStep step_;
};

/// A frame with the sightings that the configuration lets through; null if there are none.
mrpt::obs::CSensoryFrame::Ptr usable_frame(const mrpt::obs::CSensoryFrame::Ptr& frame,
                                           const Parameters& parameters) {
  const auto seen = frame ? frame->getObservationByClass<CObservationBearingRange>() : nullptr;
  if (!seen) return nullptr;
  auto copy = std::make_shared<CObservationBearingRange>(*seen);
  std::erase_if(copy->sensedData, [&](const auto& m) {
    return m.range > parameters.frontend.max_range || m.range < parameters.frontend.min_range;
  });
  if (parameters.association.method == "nearest_neighbour")
    for (auto& measured : copy->sensedData) measured.landmarkID = -1;
  if (copy->sensedData.empty()) return nullptr;
  auto out = mrpt::obs::CSensoryFrame::Create();
  out->insert(copy);
  return out;
}

}  // namespace

class MrptFilter::Impl {
 public:
  explicit Impl(const Parameters& parameters)
      : parameters_(parameters), odometry_(parameters.input), motion_(parameters) {
    filter_.options.std_sensor_range = static_cast<float>(parameters.measurement.sigma_range);
    filter_.options.std_sensor_yaw =
        static_cast<float>(parameters.measurement.sigma_bearing_deg * kPi / 180.0);
    filter_.options.data_assoc_IC_chi2_thres = parameters.association.gate_probability;
    filter_.setMinLoggingLevel(mrpt::system::LVL_ERROR);
  }

  std::optional<StepRecord> process(const LogStep& step) {
    if (step.action)
      if (const auto action = odometry_.read(step)) motion_.add(*action);
    auto frame = usable_frame(step.frame, parameters_);
    if (!frame) return std::nullopt;
    auto actions = motion_.take();
    filter_.processActionObservation(actions, frame);
    const auto used = frame->getObservationByClass<CObservationBearingRange>();
    mrpt::poses::CPosePDFGaussian pose;
    filter_.getCurrentRobotPose(pose);
    StepRecord record;
    record.index = step.index;
    record.time = step.time;
    record.pose = {pose.mean.x(), pose.mean.y(), pose.mean.phi()};
    record.cov = pose.cov.asEigen();
    record.accepted = static_cast<int>(used->sensedData.size());
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
  Parameters parameters_;
  OdometryReader odometry_;
  AccumulatedMotion motion_;
  mrpt::slam::CRangeBearingKFSLAM2D filter_;
};

MrptFilter::MrptFilter(const Parameters& parameters) : impl_(std::make_unique<Impl>(parameters)) {}
MrptFilter::~MrptFilter() = default;

std::optional<StepRecord> MrptFilter::process(const LogStep& step) {
  return impl_->process(step);
}

LandmarkMap MrptFilter::landmarks() const {
  return impl_->landmarks();
}

}  // namespace libslam
