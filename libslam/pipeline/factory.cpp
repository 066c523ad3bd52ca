#include <optional>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include <libslam/association/appearance.hpp>
#include <libslam/association/joint_compatibility.hpp>
#include <libslam/association/known.hpp>
#include <libslam/association/nearest_neighbour.hpp>
#include <libslam/association/sequential_compatibility.hpp>
#include <libslam/frontend/fiducials.hpp>
#include <libslam/frontend/range_bearing_observation.hpp>
#include <libslam/frontend/scan_lines.hpp>
#include <libslam/frontend/scan_trunks.hpp>
#include <libslam/frontend/sensor_path_observation.hpp>
#include <libslam/frontend/stereo_features.hpp>
#include <libslam/frontend/stereo_observation.hpp>
#include <libslam/io/map_file.hpp>
#include <libslam/measurement/line.hpp>
#include <libslam/measurement/range_bearing.hpp>
#include <libslam/measurement/sensor_displacement.hpp>
#include <libslam/measurement/stereo_point.hpp>
#include <libslam/motion/ackermann.hpp>
#include <libslam/motion/body_twist.hpp>
#include <libslam/motion/constant_twist.hpp>
#include <libslam/motion/differential.hpp>
#include <libslam/motion/odometry_increment.hpp>
#include <libslam/pipeline/factory.hpp>
#include <libslam/pipeline/policy_factory.hpp>
#include <libslam/policy/sage_husa.hpp>
#include <libslam/state/chi_square.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

namespace {

/// Running numbers of landmarks start here where the log has identities of its own (32 bit).
constexpr std::int64_t kBeyondIdentities = std::int64_t{1} << 32;

[[noreturn]] void throw_unknown(const std::string& what, const std::string& value) {
  throw std::invalid_argument("unknown " + what + " '" + value + "'");
}

std::unique_ptr<MeasurementModel> make_measurement(const Parameters& p) {
  if (p.measurement.model == "range_bearing") return std::make_unique<RangeBearing>();
  if (p.measurement.model == "line")
    return std::make_unique<LineMeasurement>(
        LineTolerance{p.frontend.lines.floor_alpha_deg * kPi / 180.0, p.frontend.lines.floor_r});
  if (p.measurement.model == "stereo_point")
    return std::make_unique<StereoPoint>(p.measurement.stereo.landmark_dimension);
  throw_unknown("measurement model", p.measurement.model);
}

std::unique_ptr<Associator> make_associator(const Parameters& p, const MeasurementModel& model) {
  const int dof = tangent_dimension(model.landmark_spec());
  const double gate = chi_square_quantile(p.association.gate_probability, dof);
  const auto nearest = [&] {
    return std::make_unique<NearestNeighbour>(
        gate, chi_square_quantile(p.association.new_landmark_probability, dof));
  };
  const auto joint = [&] {
    JointCompatibilityOptions options;
    options.gate_probability = p.association.gate_probability;
    options.new_landmark_probability = p.association.new_landmark_probability;
    options.dimension = dof;
    return std::make_unique<JointCompatibility>(options);
  };
  const double all = chi_square_quantile(1.0, dof);
  if (p.association.method == "known") return std::make_unique<KnownAssociation>(gate);
  if (p.association.method == "nearest_neighbour") return nearest();
  if (p.association.method == "joint_compatibility") return joint();
  if (p.association.method == "sequential_compatibility")
    return std::make_unique<SequentialCompatibility>(
        gate, chi_square_quantile(p.association.new_landmark_probability, dof));
  if (p.association.method == "known_or_nearest")
    return std::make_unique<KnownAssociation>(all, nearest());
  if (p.association.method == "known_or_joint")
    return std::make_unique<KnownAssociation>(all, joint());
  if (p.association.method == "appearance")
    return std::make_unique<AppearanceAssociation>(gate, p.association.appearance_distance,
                                                   p.association.appearance_ratio);
  throw_unknown("association method", p.association.method);
}

std::unique_ptr<LinearizationPoint> make_linearization_point(const Parameters& p,
                                                             const TrueState* truth) {
  if (p.filter.linearization == "estimate") return nullptr;
  if (p.filter.linearization == "first_estimate") return std::make_unique<FirstEstimates>();
  if (p.filter.linearization != "at_truth")
    throw_unknown("point of linearization", p.filter.linearization);
  if (truth == nullptr) throw std::invalid_argument("linearization at_truth without a truth");
  return std::make_unique<TruthPoint>(*truth);
}

/// Of a pose error in the plane, or in space with the same sigmas for every axis.
BlockMatrix pose_covariance(const BlockSpec& pose, double sigma_xy, double sigma_heading_deg) {
  TangentVector sigma(tangent_dimension(pose));
  sigma.setConstant(sigma_heading_deg * kPi / 180.0);
  sigma.head(pose.chart == Chart::kSE3 ? 3 : 2).setConstant(sigma_xy);
  return sigma.cwiseAbs2().asDiagonal();
}

BlockVector start_pose(const BlockSpec& pose, const MapParameters& map) {
  constexpr double kDegree = kPi / 180.0;
  if (pose.chart == Chart::kSE2)
    return Eigen::Vector3d(map.initial_x, map.initial_y, map.initial_heading_deg * kDegree);
  const Eigen::Quaterniond q =
      Eigen::AngleAxisd(map.initial_heading_deg * kDegree, Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(map.initial_pitch_deg * kDegree, Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(map.initial_roll_deg * kDegree, Eigen::Vector3d::UnitX());
  BlockVector start(storage_dimension(pose));
  start << map.initial_x, map.initial_y, map.initial_z, q.coeffs();
  return start;
}

std::optional<MapStart> make_map_start(const MapParameters& map) {
  if (map.file.empty()) return std::nullopt;
  MapStart start;
  start.map = std::make_shared<SavedMap>(read_map_file(map.file, map.sigma));
  start.landmarks_given = map.mode == "localize";
  start.at_saved_pose = map.start == "saved_pose";
  start.saved_calibration = map.calibration == "saved";
  return start;
}

}  // namespace

std::unique_ptr<MotionModel> make_motion_model(const MotionParameters& motion,
                                               const CalibrationParameters& calibration,
                                               const InputParameters& input) {
  if (motion.model == "body_twist") return std::make_unique<BodyTwist>(motion.twist, calibration);
  if (motion.model == "constant_twist")
    return std::make_unique<ConstantTwist>(motion.constant_twist);
  const OdometrySource source =
      input.odometry == "none" ? OdometrySource::kIncrements : odometry_source(input);
  if (motion.model == "odometry_increment")
    return std::make_unique<OdometryIncrement>(motion, calibration, source);
  if (motion.model == "differential")
    return std::make_unique<Differential>(motion, calibration, source);
  if (motion.model == "ackermann") return std::make_unique<Ackermann>(motion, calibration, source);
  throw_unknown("motion model", motion.model);
}

namespace {

/// What is done about the map and the past beside corrections.
void add_upkeep(const Parameters& p, EkfSlamParts& parts) {
  if (p.association.merge_every > 0)
    parts.merging.emplace(MergingOptions{p.association.merge_every,
                                         chi_square_quantile(p.association.merge_probability, 2),
                                         p.association.extent_gap});
  const BuildingPriorParameters& prior = p.filter.building_prior;
  if (prior.enabled)
    parts.building_prior.emplace(BuildingPriorOptions{prior.sigma_deg * kPi / 180.0,
                                                      prior.min_sightings, prior.min_length,
                                                      chi_square_quantile(prior.probability, 1)});
}

}  // namespace

EkfSlamParts make_filter_parts(const Parameters& p, const TrueState* truth) {
  EkfSlamParts parts;
  parts.motion = make_motion_model(p.motion, p.calibration, p.input);
  if (p.measurement.model == "sensor_displacement") {
    parts.displacement.emplace(std::make_unique<SensorDisplacement>(p.calibration),
                               chi_square_quantile(p.association.gate_probability, 3));
  } else {
    parts.measurement = make_measurement(p);
    parts.associator = make_associator(p, *parts.measurement);
    parts.process = make_process_policy(p, *parts.measurement);
    parts.disturbance = make_disturbance_response(p.policies.disturbance, parts.motion->pose_spec(),
                                                  parts.measurement->landmark_spec());
  }
  parts.frame = make_error_frame(p.filter.error_frame);
  parts.linearization = make_linearization_point(p, truth);
  if (p.filter.update_linearizations > 1) parts.iteration.emplace(p.filter.update_linearizations);
  parts.noise = make_noise_policy(p);
  parts.extent_gap = p.association.extent_gap;
  add_upkeep(p, parts);
  parts.registry = LandmarkRegistry(
      p.association.confirm_after, p.association.prune_after,
      p.association.uses_identities() && p.association.method != "known" ? kBeyondIdentities : 0,
      p.association.forget_after);
  if (p.policies.implied_input.enabled)
    parts.implied_input.emplace(p.policies.implied_input.probability);
  if (p.filter.delayed_pose_distance > 0.0)
    parts.delayed.emplace(DelayedPoseSpacing{p.filter.delayed_pose_distance,
                                             to_radians(p.filter.delayed_pose_turn_deg)});
  const LoopClosureParameters& loop = p.filter.loop_closure;
  if (loop.enabled)
    parts.loop_closure.emplace(
        LoopClosureOptions{loop.min_way,
                           {loop.window_xy, to_radians(loop.window_heading_deg)},
                           loop.min_score,
                           loop.min_margin,
                           loop.max_contradiction,
                           chi_square_quantile(loop.joint_probability, 3),
                           loop.confirmations,
                           loop.confirmation_distance});
  const BlockSpec pose = parts.motion->pose_spec();
  parts.map = make_map_start(p.map);
  if (parts.map && !parts.map->at_saved_pose) parts.start = start_pose(pose, p.map);
  parts.cov_start =
      pose_covariance(pose, p.filter.initial_sigma_xy, p.filter.initial_sigma_heading_deg);
  parts.cov_no_odometry =
      pose_covariance(pose, p.motion.no_odometry_sigma_xy, p.motion.no_odometry_sigma_heading_deg);
  return parts;
}

std::unique_ptr<Frontend> make_frontend(const Parameters& p) {
  if (p.frontend.source == "range_bearing")
    return std::make_unique<RangeBearingObservation>(
        p.frontend, p.measurement, p.input.sensor_label, p.association.uses_identities());
  if (p.frontend.source == "sensor_path")
    return std::make_unique<SensorPathObservation>(p.measurement, p.input.sensor_label);
  if (p.frontend.source == "stereo_points")
    return std::make_unique<StereoObservation>(
        p.frontend, p.measurement.stereo, p.input.sensor_label, p.association.uses_identities());
  if (p.frontend.source == "stereo_images")
    return std::make_unique<StereoFeatures>(p.frontend, p.input.sensor_label,
                                            p.association.uses_identities());
  if (p.frontend.source == "scan_lines")
    return std::make_unique<ScanLines>(p.frontend, p.input.sensor_label);
  if (p.frontend.source == "fiducials")
    return std::make_unique<Fiducials>(p.frontend, p.input.sensor_label);
  if (p.frontend.source == "scan_trunks")
    return std::make_unique<ScanTrunks>(p.frontend, p.measurement, p.input.sensor_label);
  throw_unknown("front-end", p.frontend.source);
}

}  // namespace libslam
