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
#include <libslam/policy/sage_husa.hpp>
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

/// The rows of the measurements of a model.
std::vector<NoiseComponent> noise_components(const Parameters& p) {
  const NoiseAdaptationParameters& n = p.policies.noise_adaptation;
  constexpr double kDegree = kPi / 180.0;
  if (p.measurement.model == "range_bearing")
    return {
        {"range", p.measurement.sigma_range, n.min_sigma_range, n.max_sigma_range,
         n.range_growth_per_m},
        {"bearing", p.measurement.sigma_bearing_deg * kDegree, n.min_sigma_bearing_deg * kDegree,
         n.max_sigma_bearing_deg * kDegree, n.bearing_growth_per_m}};
  throw_unknown("measurement model of a noise adaptation", p.measurement.model);
}

std::unique_ptr<NoisePolicy> make_noise_policy(const Parameters& p) {
  if (p.policies.noise_adaptation.method == "off") return nullptr;
  const double gate = p.association.gate_probability;
  const bool trusts_identities = p.association.method == "known_or_nearest";
  return std::make_unique<SageHusa>(p.policies.noise_adaptation, noise_components(p),
                                    GateProbabilities{trusts_identities ? 1.0 : gate, gate});
}

std::unique_ptr<ProcessScale> make_process_policy(const Parameters& p,
                                                  const MeasurementModel& model) {
  if (p.policies.process_adaptation.method == "off") return nullptr;
  const double gate =
      p.association.method == "known_or_nearest" ? 1.0 : p.association.gate_probability;
  return std::make_unique<ProcessScale>(
      p.policies.process_adaptation,
      gated_covariance(gate, tangent_dimension(model.landmark_spec())));
}

Eigen::Matrix3d planar_covariance(double sigma_xy, double sigma_heading_deg) {
  const Eigen::Vector3d sigma(sigma_xy, sigma_xy, sigma_heading_deg * kPi / 180.0);
  return sigma.cwiseAbs2().asDiagonal();
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
    parts.process = make_process_policy(p, *parts.measurement);
  }
  parts.frame = make_error_frame(p.filter.error_frame);
  parts.linearization = make_linearization_point(p, truth);
  parts.noise = make_noise_policy(p);
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
