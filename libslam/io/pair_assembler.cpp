#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <libslam/io/mrpt_fields.hpp>
#include <libslam/io/pair_assembler.hpp>

namespace libslam {
namespace {

using mrpt::obs::CAction;
using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CActionRobotMovement3D;

bool is_finite(const mrpt::poses::CPose2D& p) {
  return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.phi());
}

bool is_finite(const mrpt::poses::CPose3D& p) {
  return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()) &&
         std::isfinite(p.yaw()) && std::isfinite(p.pitch()) && std::isfinite(p.roll());
}

mrpt::poses::CPosePDF::Ptr certain(const mrpt::poses::CPose2D& mean) {
  return mrpt::poses::CPosePDFGaussian::Create(mean, mrpt::math::CMatrixDouble33());
}

/// True if the motion can be used.
bool check(CActionRobotMovement2D& motion, Intake& intake, std::int64_t entry) {
  const bool left = mend_flag(motion.hasEncodersInfo), right = mend_flag(motion.hasVelocities);
  if (left || right) intake.note(entry, "encoder or velocity flags hold garbage, fields ignored");
  const bool odometry = motion.estimationMethod == CActionRobotMovement2D::emOdometry;
  if (!motion.poseChange) motion.poseChange = certain(motion.rawOdometryIncrementReading);
  mrpt::poses::CPose2D mean;
  motion.poseChange->getMean(mean);
  if (!odometry) motion.rawOdometryIncrementReading = mean;  // not stored with a matched motion
  const bool raw_good = is_finite(motion.rawOdometryIncrementReading), mean_good = is_finite(mean);
  if (mean_good && raw_good) return true;
  if (!mean_good && !raw_good) {
    intake.skip(entry, "motion is not finite");
    return false;
  }
  if (!intake.may_repair(entry, "motion is not finite in one of its two forms")) return false;
  if (raw_good)
    motion.poseChange = certain(motion.rawOdometryIncrementReading);
  else
    motion.rawOdometryIncrementReading = mean;
  return true;
}

bool check(CActionRobotMovement3D& motion, Intake& intake, std::int64_t entry) {
  if (is_finite(motion.poseChange.mean)) return true;
  intake.skip(entry, "motion is not finite");
  return false;
}

/// The usable actions of a collection; null where none is left.
mrpt::obs::CActionCollection::Ptr usable(const mrpt::obs::CActionCollection& actions,
                                         Intake& intake, std::int64_t entry) {
  auto kept = mrpt::obs::CActionCollection::Create();
  for (const auto& item : actions) {
    const CAction::Ptr& action = item.get_ptr();
    bool good = action != nullptr;
    if (!good)
      intake.skip(entry, "null action");
    else if (auto* planar = dynamic_cast<CActionRobotMovement2D*>(action.get()))
      good = check(*planar, intake, entry);
    else if (auto* spatial = dynamic_cast<CActionRobotMovement3D*>(action.get()))
      good = check(*spatial, intake, entry);
    if (good) kept->insertPtr(action);
  }
  return kept->size() > 0 ? kept : nullptr;
}

bool has_covariance(const mrpt::obs::CActionCollection& actions) {
  for (const auto& item : actions) {
    const CAction* action = item.get();
    if (const auto* planar = dynamic_cast<const CActionRobotMovement2D*>(action)) {
      mrpt::math::CMatrixDouble33 cov;
      planar->poseChange->getCovariance(cov);
      if (!cov.asEigen().isZero(0.0)) return true;
    } else if (const auto* spatial = dynamic_cast<const CActionRobotMovement3D*>(action)) {
      if (!spatial->poseChange.cov.asEigen().isZero(0.0)) return true;
    }
  }
  return false;
}

template <typename Container>
std::optional<double> first_stamp(const Container& items) {
  for (const auto& item : items)
    if (const auto stamp = stamp_seconds(item->timestamp)) return stamp;
  return std::nullopt;
}

}  // namespace

void PairAssembler::add_action(const mrpt::obs::CActionCollection::Ptr& action,
                               std::int64_t entry) {
  if (waiting_) emit(nullptr, waiting_entry_);
  waiting_ = usable(*action, intake_, entry);
  waiting_entry_ = entry;
}

void PairAssembler::add_frame(const mrpt::obs::CSensoryFrame::Ptr& frame, std::int64_t entry) {
  emit(frame, entry);
}

void PairAssembler::finish() {
  if (waiting_) emit(nullptr, waiting_entry_);
}

double PairAssembler::place(std::optional<double> stamp, std::int64_t entry) {
  if (!stamp)
    intake_.fill_in(entry, "no valid time stamp");
  else if (clock_.any_step && *stamp < clock_.time) {
    intake_.mend(entry, "time goes back by " + std::to_string(clock_.time - *stamp) + " s");
    stamp.reset();
  }
  if (stamp) clock_.time = *stamp;
  clock_.any_step = true;
  return clock_.time;
}

void PairAssembler::emit(const mrpt::obs::CSensoryFrame::Ptr& frame, std::int64_t entry) {
  LogStep step;
  std::optional<double> stamp;
  if (frame) stamp = first_stamp(*frame);
  if (!stamp && waiting_) stamp = first_stamp(*waiting_);
  step.time = place(stamp, entry);
  if (stamp && clock_.motion_time && waiting_)
    step.dt = std::max(0.0, step.time - *clock_.motion_time);
  if (stamp) clock_.motion_time = step.time;
  step.action = std::exchange(waiting_, nullptr);
  step.has_motion_covariance = step.action && has_covariance(*step.action);
  step.frame = frame;
  ready_.push_back(std::move(step));
}

}  // namespace libslam
