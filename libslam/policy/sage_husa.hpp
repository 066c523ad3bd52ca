#pragma once
// Measurement noise estimated on line: Sage and Husa's time-varying noise estimator, per sensor.
//
//   R_i = L_i A L_i^T,   L_i = D(z_i) chol(R0_i)                          noise of measurement i
//   y_i = (S^-1 nu)_i,   S joint over all measurements                    (data/postfit.hpp)
//   residual   A <- (1 - d) A + d mean_i L_i^-1 (e_i e_i^T / kappa + H P+ H^T) L_i^-T
//              e_i = R_i y_i,  H P+ H^T = R_i - R_i (S^-1)_ii R_i
//   innovation A <- (1 - d) A + d mean_i L_i^-1 (nu_i nu_i^T / kappa - H P- H^T) L_i^-T, repaired
//   bias       r <- r + d mean_i nu_i,   nu_i = z_i - r - h(x-)
//   W <- b W + n,  d = n / W      n measurements of the sensor in this update; W starts as the
//   prior
//
// Every measurement counts the same, whether it comes alone or with twenty others; with one per
// update and no prior d is that of Sage and Husa, (1 - b) / (1 - b^k).
//
// A has no unit and starts as the identity. R0_i is what the feature brings, so that covariances
// which differ from measurement to measurement keep their sizes relative to each other, and where
// all are equal R_i is free to become any covariance. D is the diagonal of 1 + growth * distance:
// distance z_0 of a range, f baseline / z_2 of a stereo point.
//
// The residual form is a step of expectation maximization: R is the covariance of the measurement
// errors given all data so far, those at hand included: where they change R by more than a tenth,
// they are weighed again with the new R, a few times at most, so that the first frames of a sensor
// of unknown noise do not correct the state with a wrong one. It is a sum of squares, hence
// positive definite whatever comes; the innovation form is a difference. Where H P- H^T is known
// exactly both have the true R as their only fixed point; the residual form then moves by (R / S)^2
// of the step d.
//
// Positive definite but for rounding: correlations are taken a thousandth smaller than learned.
//
// A gate at probability p cuts the tail of nu: what passes has the covariance kappa S with
// kappa = F_{m+2}(g) / F_m(g), F_m the chi-square distribution with m degrees of freedom,
// F_m(g) = p. Without that factor R would settle below the truth.
//
// What a gate lets through says little about a noise that has grown threefold: at .99 half of the
// step is learned in 30 s of five updates, at .9999 nearly all. With adaptation, gate at .9999.
//
// Forgetting counts updates, not seconds: a pause says nothing about the noise, and after one a
// single observation must not replace all that was learned.
//
// Sources: Sage & Husa, Proc. Joint Automatic Control Conf. 1969; seeds.md (S3.14) with its
// safeguards; rounds within an update and a weight that counts measurements: the variational filter
// of Sarkka & Nummenmaa, IEEE Trans. Automatic Control 54 (2009) 596; truncated chi-square: Tallis,
// J. Royal Stat. Soc. B 25 (1963) 223.

#include <array>
#include <string>
#include <vector>

#include <libslam/config/parameters/noise_adaptation.hpp>
#include <libslam/policy/noise_policy.hpp>

namespace libslam {

/// One row of a measurement, in its unit.
struct NoiseComponent {
  std::string name;                 ///< "range"
  double configured = 0.0;          ///< sigma reported until the first feature has come
  double floor = 0.0, ceiling = 0;  ///< of sigma
  double growth_per_m = 0.0;        ///< of sigma, per sigma at distance 0
  std::string unit = {};
};

/// Probabilities at which the associator gates features with and without identity; 1: no gate.
struct GateProbabilities {
  double identified = 1.0, anonymous = 1.0;
};

class SageHusa final : public NoisePolicy {
 public:
  /// `components`: rows of the measurements of all sensors. Throws std::invalid_argument if there
  /// is none or too many, a floor is not below its ceiling, or a parameter is out of its range.
  SageHusa(const NoiseAdaptationParameters& parameters, std::vector<NoiseComponent> components,
           GateProbabilities gate);

  /// Throws std::invalid_argument if a feature has not the dimension of the components or its
  /// covariance is not positive definite.
  void apply(std::span<Feature> features) override;
  bool observe(std::span<Feature> features, std::span<const Postfit> accepted) override;
  /// Sigmas of the noise at distance 0, of each sensor's first feature; a number follows the name
  /// where there are several sensors.
  std::vector<AdaptedNoise> noise() const override;

  /// A of a sensor.
  const MeasurementMatrix& factor(int channel) const {
    return channels_[slot(channel)].belief.factor;
  }
  /// r of a sensor, in the unit of the measurement.
  const MeasurementVector& bias(int channel) const { return channels_[slot(channel)].belief.bias; }

 private:
  /// What was learned of a sensor.
  struct Belief {
    MeasurementMatrix factor;  ///< A
    MeasurementVector bias;    ///< r
    double weight = 0.0;       ///< W
  };
  struct Channel {
    Belief belief, before;        ///< now, and before the observation at hand
    MeasurementMatrix reference;  ///< L at distance 0 of the first feature
    bool seen = false;
    // Of the observation at hand:
    MeasurementVector weighed_with;  ///< diagonal of the A that its S was made with
    MeasurementMatrix sum;
    MeasurementVector sum_innovation;
    int count = 0;
  };
  /// Neighbouring features of one channel whose covariances came as the same.
  struct Group {
    std::size_t channel = 0;
    MeasurementMatrix configured, shape, cov;  ///< R0, L, R
    MeasurementMatrix sum;                     ///< of what its features say
    int count = 0;
  };

  std::size_t slot(int channel) const;
  /// D chol(R0).
  MeasurementMatrix shape_of(const Feature& feature, Channel& channel) const;
  /// R from A.
  void believe(Group& group) const;
  void bound(MeasurementMatrix& cov) const;
  void begin_round();
  /// To the sums of its channel.
  void add(const Group& group);
  void blend(Channel& channel) const;
  /// Gives `features` the new R if that changes much.
  bool reconsider(std::span<Feature> features);

  NoiseAdaptationParameters parameters_;
  std::vector<NoiseComponent> components_;
  bool classic_, grows_;
  double kappa_identified_, kappa_anonymous_;
  std::vector<Channel> channels_;
  std::vector<Group> groups_;          ///< of the features of the last `apply`
  std::vector<std::size_t> group_of_;  ///< by feature
  int rounds_ = 0;                     ///< of the observation at hand
};

}  // namespace libslam
