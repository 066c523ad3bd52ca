#include <cmath>
#include <stdexcept>
#include <string>

#include <libslam/pipeline/policy_factory.hpp>
#include <libslam/policy/sage_husa.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {

namespace {

/// The rows of the measurements of a model.
std::vector<NoiseComponent> noise_components(const Parameters& p) {
  const NoiseAdaptationParameters& n = p.policies.noise_adaptation;
  constexpr double kDegree = kPi / 180.0;
  if (p.measurement.model == "range_bearing")
    return {
        {"range", p.measurement.sigma_range, n.min_sigma_range, n.max_sigma_range,
         n.range_growth_per_m, "m"},
        {"bearing", p.measurement.sigma_bearing_deg * kDegree, n.min_sigma_bearing_deg * kDegree,
         n.max_sigma_bearing_deg * kDegree, n.bearing_growth_per_m, "rad"}};
  if (p.measurement.model == "stereo_point") {
    const StereoNoiseParameters& s = p.measurement.stereo;
    const double u_left = s.variance(s.sigma_u_left), u_right = s.variance(s.sigma_u_right);
    const double v_left = s.variance(s.sigma_v_left), v_right = s.variance(s.sigma_v_right);
    const auto component = [&](const char* name, double variance) {
      return NoiseComponent{
          name, std::sqrt(variance), n.min_sigma_pixel, n.max_sigma_pixel, n.pixel_growth_per_m,
          "px"};
    };
    return {component("u", u_left), component("v", v_left * v_right / (v_left + v_right)),
            component("d", u_left + u_right)};
  }
  throw std::invalid_argument("no noise adaptation for measurement model '" + p.measurement.model +
                              "'");
}

/// Probability of the gate of features with an identity; 1: none.
double gate_of_identities(const AssociationParameters& p) {
  const bool trusts = p.method == "known_or_nearest" || p.method == "known_or_joint";
  return trusts ? 1.0 : p.gate_probability;
}

}  // namespace

std::unique_ptr<NoisePolicy> make_noise_policy(const Parameters& p) {
  if (p.policies.noise_adaptation.method == "off") return nullptr;
  const double gate = p.association.gate_probability;
  return std::make_unique<SageHusa>(p.policies.noise_adaptation, noise_components(p),
                                    GateProbabilities{gate_of_identities(p.association), gate});
}

std::unique_ptr<ProcessScale> make_process_policy(const Parameters& p,
                                                  const MeasurementModel& model) {
  if (p.policies.process_adaptation.method == "off") return nullptr;
  const double gate = gate_of_identities(p.association);
  return std::make_unique<ProcessScale>(
      p.policies.process_adaptation,
      gated_covariance(gate, tangent_dimension(model.landmark_spec())));
}

std::optional<DisturbanceResponse> make_disturbance_response(const DisturbanceParameters& p,
                                                             const BlockSpec& pose,
                                                             const BlockSpec& landmark) {
  if (p.response == "none") return std::nullopt;
  DisturbanceOptions options;
  if (p.response == "additive")
    options.inflation = Inflation::kAdditive;
  else if (p.response == "whole_state")
    options.inflation = Inflation::kWholeState;
  else if (p.response != "maximum_likelihood")
    throw std::invalid_argument("unknown response to a disturbance '" + p.response + "'");
  options.window = p.window;
  options.trigger_probability = p.trigger_probability;
  options.release_probability = p.release_probability;
  options.hold = p.hold_updates;
  const int positions = pose.chart == Chart::kSE3 ? 3 : 2;
  options.sigma = BlockVector::Constant(tangent_dimension(pose), p.sigma_heading_deg * kPi / 180.0);
  options.sigma.head(positions).setConstant(p.sigma_xy);
  options.max_factor = p.max_factor;
  ResponseOptions response;
  response.near_landmark = p.near_landmark;
  response.lost_after = p.lost_after;
  response.relocalize =
      p.relocalize && pose.chart == Chart::kSE2 && tangent_dimension(landmark) == 2;
  // All of P grows by the literal form: there is nothing to take back.
  if (p.response != "whole_state") response.slip_probability = p.slip_probability;
  return DisturbanceResponse(Disturbance(options), response);
}

}  // namespace libslam
