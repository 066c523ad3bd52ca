#include <numbers>
#include <stdexcept>

#include <libslam/filter/building_prior.hpp>

namespace libslam {

BuildingPrior::BuildingPrior(const BuildingPriorOptions& options)
    : options_(options), model_(options.sigma) {
  if (!(options.gate > 0.0)) throw std::invalid_argument("the building prior needs a gate");
}

void BuildingPrior::add_to(GaussianState& state) {
  // As good as no knowledge: the first wall moves the direction to where it belongs but for a
  // thousandth of the difference.
  constexpr double kUnknown = std::numbers::pi * std::numbers::pi;
  direction_ = state.add(DirectionPrior::direction_spec(), Eigen::VectorXd::Zero(1),
                         Eigen::MatrixXd::Constant(1, 1, kUnknown));
}

void BuildingPrior::apply(GaussianState& state, Ekf& ekf, BlockId pose,
                          LandmarkRegistry& registry) {
  for (std::size_t i = 0; i < registry.size(); ++i) {
    const RegisteredLandmark& line = registry.landmarks()[i];
    if (line.prior_judged || line.times_seen < options_.min_sightings || !line.extent ||
        line.extent->length() < options_.min_length || state.is_constant(line.block))
      continue;
    registry.mark_prior_judged(i);
    ++judged_;
    model_.linearize(state, direction_, line.block, measurement_);
    if (ekf.innovate(state, measurement_).mahalanobis2 > options_.gate)
      ++oblique_;
    else
      ekf.correct(state, pose, {&measurement_, 1});
  }
}

}  // namespace libslam
