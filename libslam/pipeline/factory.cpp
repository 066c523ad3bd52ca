#include <optional>
#include <stdexcept>
#include <string>

#include <libslam/association/known.hpp>
#include <libslam/association/nearest_neighbour.hpp>
#include <libslam/frontend/range_bearing_observation.hpp>
#include <libslam/frontend/sensor_path_observation.hpp>
#include <libslam/measurement/range_bearing.hpp>
#include <libslam/measurement/sensor_displacement.hpp>
#include <libslam/motion/ackermann.hpp>
#include <libslam/motion/differential.hpp>
#include <libslam/motion/odometry_increment.hpp>
#include <libslam/pipeline/factory.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {

namespace {

/// Running numbers of landmarks start here where the log has identities of its own (32 bit).
constexpr std::int64_t kBeyondIdentities = std::int64_t{1} << 32;

[[noreturn]] void throw_unknown(const std::string& what, const std::string& value) {
  throw std::invalid_argument("unknown " + what + " '" + value + "'");
}

std::unique_ptr<MeasurementModel> make_measurement(const Parameters& p) {
  if (p.measurement.model == "range_bearing") return std::make_unique<RangeBearing>();
  throw_unknown("measurement model", p.measurement.model);
}

std::unique_ptr<Associator> make_associator(const Parameters& p, const MeasurementModel& model) {
  const int dof = tangent_dimension(model.landmark_spec());
  const double gate = chi_square_quantile(p.association.gate_probability, dof);
  const auto nearest = [&] {
    return std::make_unique<NearestNeighbour>(
        gate, chi_square_quantile(p.association.new_landmark_probability, dof));
  };
  if (p.association.method == "known") return std::make_unique<KnownAssociation>(gate);
  if (p.association.method == "nearest_neighbour") return nearest();
  if (p.association.method == "known_or_nearest")
    return std::make_unique<KnownAssociation>(chi_square_quantile(1.0, dof), nearest());
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

Eigen::Matrix3d planar_covariance(double sigma_xy, double sigma_heading_deg) {
  const Eigen::Vector3d sigma(sigma_xy, sigma_xy, sigma_heading_deg * kPi / 180.0);
  return sigma.cwiseAbs2().asDiagonal();
}

std::optional<DisturbanceResponse> make_disturbance_response(const DisturbanceParameters& p,
                                                             const BlockSpec& pose) {
  if (p.response == "none") return std::nullopt;
  DisturbanceOptions options;
  if (p.response == "additive")
    options.inflation = Inflation::kAdditive;
  else if (p.response == "whole_state")
    options.inflation = Inflation::kWholeState;
  else if (p.response != "maximum_likelihood")
    throw_unknown("response to a disturbance", p.response);
  options.window = p.window;
  options.trigger_probability = p.trigger_probability;
  options.release_probability = p.release_probability;
  options.hold = p.hold_updates;
  const int positions = pose.chart == Chart::kSE3 ? 3 : 2;
  options.sigma =
      BlockVector::Constant(tangent_dimension(pose), p.sigma_heading_deg * kPi / 180.0);
  options.sigma.head(positions).setConstant(p.sigma_xy);
  options.max_factor = p.max_factor;
  return DisturbanceResponse(Disturbance(options), p.near_landmark, p.lost_after);
}

}  // namespace

std::unique_ptr<MotionModel> make_motion_model(const MotionParameters& motion,
                                               const CalibrationParameters& calibration,
                                               const InputParameters& input) {
  const OdometrySource source =
      input.odometry == "none" ? OdometrySource::kIncrements : odometry_source(input);
  if (motion.model == "odometry_increment")
    return std::make_unique<OdometryIncrement>(motion, calibration, source);
  if (motion.model == "differential")
    return std::make_unique<Differential>(motion, calibration, source);
  if (motion.model == "ackermann") return std::make_unique<Ackermann>(motion, calibration, source);
  throw_unknown("motion model", motion.model);
}

EkfSlamParts make_filter_parts(const Parameters& p, const TrueState* truth) {
  EkfSlamParts parts;
  parts.motion = make_motion_model(p.motion, p.calibration, p.input);
  if (p.measurement.model == "sensor_displacement") {
    parts.displacement.emplace(std::make_unique<SensorDisplacement>(p.calibration),
                               chi_square_quantile(p.association.gate_probability, 3));
  } else {
    parts.measurement = make_measurement(p);
    parts.associator = make_associator(p, *parts.measurement);
  }
  parts.disturbance = make_disturbance_response(p.policies.disturbance, parts.motion->pose_spec());
  parts.frame = make_error_frame(p.filter.error_frame);
  parts.linearization = make_linearization_point(p, truth);
  parts.registry =
      LandmarkRegistry(p.association.confirm_after, p.association.prune_after,
                       p.association.method == "known_or_nearest" ? kBeyondIdentities : 0);
  parts.cov_start =
      planar_covariance(p.filter.initial_sigma_xy, p.filter.initial_sigma_heading_deg);
  parts.cov_no_odometry =
      planar_covariance(p.motion.no_odometry_sigma_xy, p.motion.no_odometry_sigma_heading_deg);
  return parts;
}

std::unique_ptr<Frontend> make_frontend(const Parameters& p) {
  if (p.frontend.source == "range_bearing")
    return std::make_unique<RangeBearingObservation>(p.frontend, p.measurement,
                                                     p.input.sensor_label,
                                                     p.association.method != "nearest_neighbour");
  if (p.frontend.source == "sensor_path")
    return std::make_unique<SensorPathObservation>(p.measurement, p.input.sensor_label);
  throw_unknown("front-end", p.frontend.source);
}

}  // namespace libslam
