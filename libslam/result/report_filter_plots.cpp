#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <libslam/result/report_filter_plots.hpp>
#include <libslam/result/report_series.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {
namespace {

using Json = nlohmann::ordered_json;

/// A plot of panels over the abscissas of `series`; `good` says what a healthy run looks like.
void add_plot(Json& plots, const char* title, const char* value, const char* good,
              const SeriesEnvelope& series, Json panels) {
  plots.push_back({{"title", title},
                   {"value", value},
                   {"good", good},
                   {"t", abscissas(series)},
                   {"panels", std::move(panels)}});
}

class InnovationPlot {
 public:
  explicit InnovationPlot(std::size_t rows) : mean_(rows) {}

  void add(double time, const StepRecord& step) {
    if (step.nis_dof <= 0) return;
    const auto dof = static_cast<std::size_t>(step.nis_dof);
    if (dof >= bounds_.size()) bounds_.resize(dof + 1, {0.0, 0.0});
    if (bounds_[dof].second == 0.0)
      bounds_[dof] = {chi_square_quantile(0.025, step.nis_dof) / step.nis_dof,
                      chi_square_quantile(0.975, step.nis_dof) / step.nis_dof};
    const double nis = step.nis / step.nis_dof;
    series_.add(time, std::array{nis, bounds_[dof].first, bounds_[dof].second, mean_.add(nis)});
  }

  void append_to(Json& plots) const {
    if (series_.size() == 0) return;
    Json nis = panel("NIS / dof", "1", series_, 0);
    nis["band"] = band("95 % of a consistent filter", series_, 1, 2);
    nis["level"] = {{"name", "ideal mean 1"}, {"value", 1.0}};
    nis["mean"] = channel(series_, 3, Edge::high);
    nis["log"] = true;
    add_plot(plots, "Innovations (NIS)", "NIS per degree of freedom",
             "Divided by its degrees of freedom the squared innovation should average 1 and leave "
             "the band in 5 % of the updates; steadily above it the noise is set too small.",
             series_, Json::array({nis}));
  }

 private:
  SeriesEnvelope series_{4, kPlotBuckets};
  MovingMean mean_;
  std::vector<std::pair<double, double>> bounds_;  // by degrees of freedom
};

class CalibrationPlot {
 public:
  explicit CalibrationPlot(const std::vector<std::string>& names)
      : names_(names), series_(std::max<std::size_t>(1, 3 * names.size()), kPlotBuckets) {}

  void add(double time, const StepRecord& step) {
    if (names_.empty()) return;
    row_.clear();
    for (const CalibrationValue& value : step.calibration)
      row_.insert(row_.end(),
                  {value.mean, value.mean - 3.0 * value.sigma, value.mean + 3.0 * value.sigma});
    series_.add(time, row_);
  }

  void append_to(Json& plots, const GroundTruth& truth) const {
    if (names_.empty()) return;
    Json panels = Json::array();
    for (std::size_t i = 0; i < names_.size(); ++i) {
      panels.push_back(panel(names_[i].c_str(), "", series_, 3 * i));
      panels[i]["band"] = band("\u00b13\u03c3", series_, 3 * i + 1, 3 * i + 2);
      if (const auto known = truth.calibration.find(names_[i]); known != truth.calibration.end())
        panels[i]["level"] = {{"name", "true value"}, {"value", known->second}};
    }
    add_plot(
        plots, "Calibration", "estimate",
        "Each parameter should settle while its band shrinks and keeps the true value inside; a "
        "band that never shrinks means that the motion did not excite the parameter.",
        series_, std::move(panels));
  }

 private:
  const std::vector<std::string>& names_;
  SeriesEnvelope series_;
  std::vector<double> row_;
};

class NoisePlot {
 public:
  explicit NoisePlot(const std::vector<std::string>& names)
      : names_(names), series_(std::max<std::size_t>(1, names.size()), kPlotBuckets) {}

  void add(double time, const StepRecord& step) {
    if (names_.empty()) return;
    row_.clear();
    for (const AdaptedNoise& noise : step.noise) row_.push_back(noise.sigma);
    series_.add(time, row_);
  }

  void append_to(Json& plots, const std::vector<AdaptedNoise>& final_noise) const {
    if (names_.empty()) return;
    Json panels = Json::array();
    for (std::size_t i = 0; i < names_.size(); ++i) {
      panels.push_back(panel(("\u03c3 " + names_[i]).c_str(), "", series_, i));
      panels[i]["log"] = true;
      for (const AdaptedNoise& noise : final_noise)
        if (noise.name == names_[i] && noise.configured > 0.0)
          panels[i]["level"] = {{"name", "as configured"}, {"value", noise.configured}};
    }
    add_plot(plots, "Adapted noise", "adapted sigma",
             "Each sigma should settle where the innovations put it and move only when the sensor "
             "changes; one that stays at a limit or never rests is not identified.",
             series_, std::move(panels));
  }

 private:
  const std::vector<std::string>& names_;
  SeriesEnvelope series_;
  std::vector<double> row_;
};

}  // namespace

void add_filter_plots(Json& plots, const ReportInput& in, const RunAxis& axis) {
  TrajectoryReader reader(in.trajectory_csv);
  InnovationPlot innovations(in.path.poses.size());
  CalibrationPlot calibration(reader.columns().calibration);
  NoisePlot noise(reader.columns().noise);
  for (StepRecord step; reader.next(step);) {
    const double time = axis.at(step.index, step.time);
    innovations.add(time, step);
    calibration.add(time, step);
    noise.add(time, step);
  }
  innovations.append_to(plots);
  calibration.append_to(plots, in.truth);
  noise.append_to(plots, in.summary.result.noise);
}

}  // namespace libslam
