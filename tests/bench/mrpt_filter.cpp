#include <bench/mrpt_filter.hpp>

#include <mrpt/config/CConfigFile.h>

namespace libslam::bench {

MrptFilter::MrptFilter(Method method) {
  filter_.setMinLoggingLevel(mrpt::system::LVL_ERROR);
  filter_.KF_options.method =
      method == Method::kDavison ? mrpt::bayes::kfEKFAlaDavison : mrpt::bayes::kfEKFNaive;
}

MrptFilter::MrptFilter(Method method, double sigma_range, double sigma_bearing)
    : MrptFilter(method) {
  filter_.options.std_sensor_range = static_cast<float>(sigma_range);
  filter_.options.std_sensor_yaw = static_cast<float>(sigma_bearing);
}

MrptFilter::MrptFilter(Method method, const std::string& ini_file) : MrptFilter(method) {
  filter_.options.loadFromConfigFile(mrpt::config::CConfigFile(ini_file), "RangeBearingKFSLAM");
}

void MrptFilter::process(const LogStep& step) {
  auto action = step.action;
  auto frame = step.frame;
  filter_.processActionObservation(action, frame);
}

Eigen::Vector3d MrptFilter::pose() const {
  mrpt::poses::CPosePDFGaussian pose;
  filter_.getCurrentRobotPose(pose);
  return {pose.mean.x(), pose.mean.y(), pose.mean.phi()};
}

std::size_t MrptFilter::landmarks() const {
  mrpt::poses::CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> landmarks;
  std::map<unsigned int, mrpt::maps::CLandmark::TLandmarkID> ids;
  mrpt::math::CVectorDouble state;
  mrpt::math::CMatrixDouble covariance;
  filter_.getCurrentState(pose, landmarks, ids, state, covariance);
  return landmarks.size();
}

}  // namespace libslam::bench
