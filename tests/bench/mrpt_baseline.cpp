// mrpt-baseline CONFIG RAWLOG --out DIR: MRPT's own CRangeBearingKFSLAM2D on a log, with the motion
// noise, the sensor sigmas and the gate of CONFIG, into a run directory that slam-evaluate compares
// with ours.

#include <ctime>
#include <iostream>

#include <CLI/CLI.hpp>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>

#include <libslam/config/yaml_loader.hpp>
#include <libslam/frontend/odometry.hpp>
#include <libslam/io/rawlog_player.hpp>
#include <libslam/io/truth_reader.hpp>
#include <libslam/pipeline/factory.hpp>
#include <libslam/result/atomic_file.hpp>
#include <libslam/result/recorder.hpp>

namespace {

using namespace libslam;
using mrpt::obs::CObservationBearingRange;

/// The motion since the last frame, with the covariance of our motion model.
class AccumulatedMotion {
 public:
  explicit AccumulatedMotion(const Parameters& parameters)
      : model_(make_filter_parts(parameters).motion) {
    reset();
  }

  void add(const MotionAction& action) {
    model_->linearize(state_, pose_, {}, action, step_);
    const BlockMatrix f = step_.wrt.begin()->jacobian;
    const BlockMatrix cov = f * state_.covariance_of(pose_) * f.transpose() + step_.cov_noise;
    const Eigen::VectorXd estimate = step_.estimate;
    state_ = GaussianState();
    pose_ = state_.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, estimate, cov);
  }

  mrpt::obs::CActionCollection::Ptr take() {
    mrpt::poses::CPosePDFGaussian change;
    const auto mean = state_.estimate(pose_);
    change.mean = {mean[0], mean[1], mean[2]};
    change.cov = mrpt::math::CMatrixDouble33(Eigen::Matrix3d(state_.covariance_of(pose_)));
    mrpt::obs::CActionRobotMovement2D movement;
    movement.rawOdometryIncrementReading = change.mean;
    movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(change);
    auto actions = mrpt::obs::CActionCollection::Create();
    actions->insert(movement);
    reset();
    return actions;
  }

 private:
  void reset() {
    state_ = GaussianState();
    pose_ = state_.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, Eigen::Vector3d::Zero(),
                       Eigen::Matrix3d::Zero());
  }

  std::unique_ptr<MotionModel> model_;
  GaussianState state_;
  BlockId pose_;
  MotionStep step_;
};

/// A frame with the range-bearing observation that the configuration lets through; null if there is
/// none.
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

LandmarkMap map_of(const mrpt::slam::CRangeBearingKFSLAM2D& filter) {
  mrpt::poses::CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> points;
  std::map<unsigned int, mrpt::maps::CLandmark::TLandmarkID> ids;
  mrpt::math::CVectorDouble state;
  mrpt::math::CMatrixDouble cov;
  filter.getCurrentState(pose, points, ids, state, cov);
  LandmarkMap map;
  for (unsigned int i = 0; i < points.size(); ++i) {
    const Eigen::Matrix2d block = cov.asEigen().block<2, 2>(3 + 2 * i, 3 + 2 * i);
    const std::int64_t id = ids.count(i) ? static_cast<std::int64_t>(ids.at(i)) : i;
    map.add({id, "point", Eigen::Vector2d(points[i].x, points[i].y), block, 1});
  }
  return map;
}

int run(const std::string& config, const std::string& rawlog, const std::string& directory) {
  Parameters parameters = load_yaml(config);
  parameters.calibration = {};
  mrpt::slam::CRangeBearingKFSLAM2D filter;
  filter.options.std_sensor_range = static_cast<float>(parameters.measurement.sigma_range);
  filter.options.std_sensor_yaw =
      static_cast<float>(parameters.measurement.sigma_bearing_deg * kPi / 180.0);
  filter.options.data_assoc_IC_chi2_thres = parameters.association.gate_probability;
  filter.setMinLoggingLevel(mrpt::system::LVL_ERROR);

  RawlogPlayer player(rawlog);
  OdometryReader odometry(parameters.input);
  AccumulatedMotion motion(parameters);
  Recorder recorder({directory, true, 0.0, true});
  replace_file(std::filesystem::path(directory) / "config.yaml", to_yaml(parameters));
  double cpu_s = 0.0;
  std::int64_t index = 0;
  while (const auto step = player.next()) {
    if (step->action)
      if (const auto action = odometry.read(*step)) motion.add(*action);
    auto frame = usable_frame(step->frame, parameters);
    if (!frame) continue;
    auto actions = motion.take();
    const std::clock_t begin = std::clock();
    filter.processActionObservation(actions, frame);
    const double spent = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    cpu_s += spent;
    mrpt::poses::CPosePDFGaussian pose;
    filter.getCurrentRobotPose(pose);
    StepRecord record;
    record.index = step->index;
    record.time = step->time;
    record.pose = {pose.mean.x(), pose.mean.y(), pose.mean.phi()};
    record.cov = pose.cov.asEigen();
    record.step_ms = 1e3 * spent;
    recorder.record(record);
    ++index;
  }
  RunSummary summary;
  summary.program = "mrpt-baseline";
  summary.version = "MRPT";
  summary.input.file = rawlog;
  summary.timing.cpu_s = cpu_s;
  summary.timing.steps = index;
  const auto identity = parameters.association.method == "nearest_neighbour"
                            ? LandmarkIdentity::unknown
                            : LandmarkIdentity::known;
  const LandmarkMap map = map_of(filter);
  recorder.finish(summary, map, read_truth(find_truth(rawlog)), identity);
  std::cout << map.size() << " landmarks, " << cpu_s << " s CPU in the filter, " << directory
            << '\n';
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("MRPT's CRangeBearingKFSLAM2D on a log, for comparison.");
  std::string config, rawlog, out;
  app.add_option("config", config)->required();
  app.add_option("rawlog", rawlog)->required();
  app.add_option("--out", out)->required();
  CLI11_PARSE(app, argc, argv);
  try {
    return run(config, rawlog, out);
  } catch (const std::exception& e) {
    std::cerr << "mrpt-baseline: " << e.what() << '\n';
    return 1;
  }
}
