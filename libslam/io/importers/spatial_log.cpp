#include <algorithm>
#include <random>
#include <stdexcept>

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationStereoImagesFeatures.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <nlohmann/json.hpp>

#include <libslam/io/importers/spatial_log.hpp>
#include <libslam/io/truth_writer.hpp>
#include <libslam/state/so3.hpp>

namespace libslam {
namespace {

using mrpt::obs::CObservationStereoImagesFeatures;

mrpt::poses::CPose3DQuat to_pose(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d p = T.translation();
  return {p.x(), p.y(), p.z(), mrpt::math::CQuaternionDouble(q.w(), q.x(), q.y(), q.z())};
}

mrpt::img::TCamera to_camera(const StereoCamera& camera) {
  mrpt::img::TCamera out;
  out.ncols = static_cast<std::uint32_t>(camera.width);
  out.nrows = static_cast<std::uint32_t>(camera.height);
  out.setIntrinsicParamsFromValues(camera.fx, camera.fy, camera.cx, camera.cy);
  return out;
}

class SpatialLogWriter {
 public:
  SpatialLogWriter(const StereoCamera& camera, const std::string& file) {
    if (!out_.open(file)) throw std::runtime_error(file + ": cannot be written");
    blank_.sensorLabel = "stereo";
    blank_.cameraLeft = blank_.cameraRight = to_camera(camera);
    blank_.rightCameraPose.x(camera.baseline);
    blank_.cameraPoseOnRobot = to_pose(camera.T_robot_camera);
  }

  void write_action(const SpatialStep& step, double dt) {
    mrpt::obs::CActionRobotMovement3D motion;
    motion.timestamp = mrpt::Clock::fromDouble(step.time);
    // MRPT recomputes poseChange from its own motion model, by sampling, when it reads an action of
    // method odometry.
    motion.estimationMethod = mrpt::obs::CActionRobotMovement3D::emVisualOdometry;
    motion.hasVelocities.assign(6, true);
    const auto v = step.twist.cast<float>().eval();
    for (const int i : {0, 1, 2}) {
      motion.velocities[i] = v[i];
      motion.velocities[3 + i] = v[5 - i];  // yaw, pitch, roll
    }
    const Eigen::Matrix<double, 6, 1> moved = dt * step.twist;
    const Eigen::Isometry3d T =
        Eigen::Translation3d(so3_left_jacobian(moved.tail<3>()) * moved.head<3>()) *
        so3_exp(moved.tail<3>());
    motion.poseChange.mean = mrpt::poses::CPose3D(to_pose(T));
    motion.rawOdometryIncrementReading = motion.poseChange.mean;
    mrpt::obs::CActionCollection actions;
    actions.insert(motion);
    *archive_ << actions;
  }

  void write_frame(const SpatialStep& step) {
    auto points = std::make_shared<CObservationStereoImagesFeatures>(blank_);
    points->timestamp = mrpt::Clock::fromDouble(step.time);
    for (const StereoSighting& sighting : step.sightings) {
      const Eigen::Vector4f q = sighting.pixels.cast<float>();
      points->theFeatures.push_back(
          {{mrpt::img::TPixelCoordf(q[0], q[1]), mrpt::img::TPixelCoordf(q[2], q[3])},
           static_cast<unsigned>(sighting.id)});
    }
    mrpt::obs::CSensoryFrame frame;
    frame.insert(points);
    *archive_ << frame;
  }

 private:
  CObservationStereoImagesFeatures blank_;  // without points
  mrpt::io::CFileGZOutputStream out_;
  mrpt::serialization::CArchive::UniquePtr archive_ =
      mrpt::serialization::archiveUniquePtrFrom(out_);
};

bool write_rawlog(const SpatialLog& log, const std::string& file,
                  const std::function<bool()>& interrupted) {
  SpatialLogWriter writer(log.camera, file);
  for (std::size_t i = 0; i < log.steps.size(); ++i) {
    if (interrupted && interrupted()) return false;
    if (i > 0) writer.write_action(log.steps[i], log.steps[i].time - log.steps[i - 1].time);
    writer.write_frame(log.steps[i]);
  }
  return true;
}

std::string notes_text(const SpatialLog& log) {
  nlohmann::json json;
  json["scenario"] = log.scenario;
  json["calibration"] = log.truth.calibration;
  json["parameters"] = log.parameters;
  json["remarks"] = log.remarks;
  return json.dump(2) + "\n";
}

/// The landmark with this identity, or null.
const TrueLandmark* find_landmark(const GroundTruth& truth, std::int64_t id) {
  const auto found = std::ranges::find(truth.landmarks, id, &TrueLandmark::id);
  return found == truth.landmarks.end() ? nullptr : &*found;
}

}  // namespace

void simulate_pixels(SpatialLog& log, const Eigen::Vector4d& sigma, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const Trajectory& path = log.truth.path;
  for (SpatialStep& step : log.steps) {
    const auto place = std::ranges::lower_bound(path.times, step.time);
    const bool known = place != path.times.end() && *place == step.time;
    std::vector<StereoSighting> seen;
    if (known) {
      const SpatialPose& pose = path.spatial[static_cast<std::size_t>(place - path.times.begin())];
      const Eigen::Isometry3d T_camera_world =
          (pose.isometry() * log.camera.T_robot_camera).inverse();
      for (const StereoSighting& sighting : step.sightings) {
        const TrueLandmark* const landmark = find_landmark(log.truth, sighting.id);
        if (landmark == nullptr) continue;
        const Eigen::Vector3d p = T_camera_world * Eigen::Vector3d(landmark->position);
        if (!(p.z() > 0.0)) continue;
        const StereoCamera& c = log.camera;
        const double u = c.cx + c.fx * p.x() / p.z(), v = c.cy + c.fy * p.y() / p.z();
        Eigen::Vector4d pixels(u, v, u - c.fx * c.baseline / p.z(), v);
        for (Eigen::Index i = 0; i < 4; ++i) pixels[i] += sigma[i] * normal(random);
        seen.push_back({sighting.id, pixels});
      }
    }
    step.sightings = std::move(seen);
  }
  log.remarks["pixels"] =
      "simulated: true projections with white noise, seed " + std::to_string(seed);
}

bool write_spatial_log(const SpatialLog& log, const std::string& rawlog,
                       const std::function<bool()>& interrupted) {
  remove_truth_beside(rawlog);
  const bool complete = write_rawlog(log, rawlog, interrupted);
  write_truth_beside(rawlog, log.truth, notes_text(log));
  return complete;
}

}  // namespace libslam
