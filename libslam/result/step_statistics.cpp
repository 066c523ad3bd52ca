#include <algorithm>
#include <cmath>
#include <span>

#include <libslam/data/step_events.hpp>
#include <libslam/result/step_statistics.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {
namespace {

constexpr std::size_t kStepTimeBuckets = 2000;

}  // namespace

void LogHistogram::add(double value) {
  const double bin = value > kLowest ? std::log(value / kLowest) / std::log(kRatio) : 0.0;
  ++counts_[std::min(kBins - 1, static_cast<std::size_t>(std::min(bin, double{kBins})))];
  ++total_;
}

double LogHistogram::quantile(double probability) const {
  const auto rank = static_cast<std::int64_t>(std::ceil(probability * static_cast<double>(total_)));
  std::int64_t below = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    below += counts_[bin];
    if (below > 0 && below >= rank)
      return kLowest * std::pow(kRatio, static_cast<double>(bin) + 0.5);
  }
  return 0.0;
}

StepStatistics::StepStatistics() : step_times_(1, kStepTimeBuckets) {}

void StepStatistics::add(const StepRecord& step) {
  ++steps_;
  accepted_ += step.accepted;
  gated_ += step.gated;
  if (step.nis_dof > 0) {
    ++updates_;
    nis_sum_ += step.nis;
    nis_dof_ += step.nis_dof;
    const Band& band = nis_band(step.nis_dof);
    nis_inside_ += step.nis >= band.lower && step.nis <= band.upper;
  }
  ms_.add(step.step_ms);
  ms_sum_ += step.step_ms;
  ms_max_ = std::max(ms_max_, step.step_ms);
  step_times_.add(static_cast<double>(step.index), std::span(&step.step_ms, 1));
  calibration_ = step.calibration;
  noise_ = step.noise;
  for_each_event(step.event, [&](std::string_view name) {
    disturbances_ += name == "disturbance";
    if (events_.size() < kMostEvents) events_.push_back({step.time, step.index, std::string(name)});
  });
}

const StepStatistics::Band& StepStatistics::nis_band(int dof) {
  const auto index = static_cast<std::size_t>(dof);
  if (index >= nis_bands_.size()) nis_bands_.resize(index + 1, {0.0, 0.0});
  Band& band = nis_bands_[index];
  if (band.upper == 0.0) band = {chi_square_quantile(0.025, dof), chi_square_quantile(0.975, dof)};
  return band;
}

void StepStatistics::fill(RunSummary& summary) const {
  summary.timing.steps = steps_;
  summary.health.events = events_;
  if (steps_ > 0)
    summary.timing.step_ms = {
        {ms_sum_ / static_cast<double>(steps_), ms_.quantile(0.5), ms_.quantile(0.95), ms_max_}};
  if (updates_ > 0) {
    summary.health.nis_mean = nis_sum_ / static_cast<double>(nis_dof_);
    summary.health.nis_in_95 = static_cast<double>(nis_inside_) / static_cast<double>(updates_);
  }
  if (accepted_ + gated_ > 0)
    summary.health.gated_fraction =
        static_cast<double>(gated_) / static_cast<double>(accepted_ + gated_);
}

}  // namespace libslam
