#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Dense>
#include <mrpt/math/wrap2pi.h>

#include <libslam/result/alignment.hpp>
#include <libslam/result/report_data.hpp>
#include <libslam/result/report_map_data.hpp>
#include <libslam/result/run_axis.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {
namespace {

using Json = nlohmann::ordered_json;
using mrpt::math::TPose2D;

constexpr std::size_t kBuckets = 1400;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Json abscissas(const SeriesEnvelope& series) {
  Json t = Json::array();
  for (std::size_t i = 0; i < series.size(); ++i) t.push_back(short_number(series.abscissa(i)));
  return t;
}

/// Mean that forgets: over about a fortieth of a series of `length` values. NaN passes through
/// without effect.
class MovingMean {
 public:
  explicit MovingMean(std::size_t length)
      : rate_(std::min(1.0, 40.0 / static_cast<double>(std::max<std::size_t>(1, length)))) {}
  double add(double value) {
    if (!std::isfinite(value)) return kNone;
    weight_ += rate_ * (1.0 - weight_);  // corrects for the start from nothing
    sum_ += rate_ * (value - sum_);
    return sum_ / weight_;
  }

 private:
  double rate_, weight_ = 0.0, sum_ = 0.0;
};

enum class Edge { low, high };

Json channel(const SeriesEnvelope& series, std::size_t index, Edge edge) {
  Json values = Json::array();
  for (std::size_t i = 0; i < series.size(); ++i) {
    const auto range = series.range(i, index);
    values.push_back(short_number(static_cast<double>(edge == Edge::low ? range.low : range.high)));
  }
  return values;
}

Json panel(const char* label, const char* unit, const SeriesEnvelope& series, std::size_t value) {
  return {{"label", label},
          {"unit", unit},
          {"low", channel(series, value, Edge::low)},
          {"high", channel(series, value, Edge::high)}};
}

Json band(const char* name, const SeriesEnvelope& series, std::size_t low, std::size_t high) {
  return {{"name", name},
          {"low", channel(series, low, Edge::low)},
          {"high", channel(series, high, Edge::high)}};
}

/// Errors in the filter's frame with their sigmas, and NEES, over the matched poses.
void add_error_plots(Json& plots, const ReportInput& in, std::span<const EstimatedPose> path,
                     const RunAxis& axis, std::span<const PoseMatch> matches,
                     const TPose2D& T_truth_filter) {
  const bool heading = in.truth.path.has_heading;
  const TPose2D T_filter_truth = invert(T_truth_filter);
  const std::vector<double> nees =
      heading ? pose_nees(path, in.truth.path, matches) : std::vector<double>();
  SeriesEnvelope errors(9, kBuckets), consistency(2, kBuckets);
  MovingMean mean_nees(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const EstimatedPose& estimate = path[matches[i].estimate];
    Eigen::Vector3d e =
        estimate.pose - transform_pose(T_filter_truth, in.truth.path.poses[matches[i].truth]);
    e.z() = heading ? mrpt::math::wrapToPi(e.z()) : kNone;
    const Eigen::Vector3d bound = 3.0 * estimate.cov.diagonal().cwiseMax(0.0).cwiseSqrt();
    const double time = axis.at(estimate);
    errors.add(time, std::array{e.x(), e.y(), e.z(), -bound.x(), bound.x(), -bound.y(), bound.y(),
                                -bound.z(), bound.z()});
    if (heading) consistency.add(time, std::array{nees[i], mean_nees.add(nees[i])});
  }
  Json panels = Json::array();
  panels.push_back(panel("x error", "m", errors, 0));
  panels.push_back(panel("y error", "m", errors, 1));
  if (heading) panels.push_back(panel("heading error", "rad", errors, 2));
  for (std::size_t i = 0; i < panels.size(); ++i)
    panels[i]["band"] = band("\u00b13\u03c3", errors, 3 + 2 * i, 4 + 2 * i);
  plots.push_back(
      {{"title", "Pose error"},
       {"value", "error"},
       {"good",
        "A consistent filter keeps the error inside the \u00b13\u03c3 band nearly always, "
        "and uses the band: errors far smaller than it mean a timid covariance."},
       {"t", abscissas(errors)},
       {"panels", panels}});
  if (!heading) return;
  Json nees_panel = panel("NEES", "1", consistency, 0);
  nees_panel["interval"] = {{"name", "95 % of a consistent filter"},
                            {"low", short_number(chi_square_quantile(0.025, 3))},
                            {"high", short_number(chi_square_quantile(0.975, 3))}};
  nees_panel["level"] = {{"name", "ideal mean 3"}, {"value", 3.0}};
  nees_panel["mean"] = channel(consistency, 1, Edge::high);
  nees_panel["log"] = true;
  plots.push_back(
      {{"title", "Consistency of the pose (NEES)"},
       {"value", "NEES"},
       {"good",
        "The squared error in units of its covariance should move around 3 and stay inside the "
        "band for 95 % of the steps; above it the filter is overconfident."},
       {"t", abscissas(consistency)},
       {"panels", Json::array({nees_panel})}});
}

/// Innovations and calibration come from the file, not from memory: only their envelope is kept.
void add_filter_plots(Json& plots, const ReportInput& in, const RunAxis& axis) {
  TrajectoryReader reader(in.trajectory_csv);
  const std::vector<std::string>& names = reader.calibration_names();
  SeriesEnvelope innovations(4, kBuckets);
  MovingMean mean_nis(in.path.size());
  SeriesEnvelope calibration(std::max<std::size_t>(1, 3 * names.size()), kBuckets);
  std::vector<double> row(calibration.channels());
  std::vector<std::pair<double, double>> bounds;  // by degrees of freedom
  for (StepRecord step; reader.next(step);) {
    const double time = axis.at(step.index, step.time);
    if (step.nis_dof > 0) {
      const auto dof = static_cast<std::size_t>(step.nis_dof);
      if (dof >= bounds.size()) bounds.resize(dof + 1, {0.0, 0.0});
      if (bounds[dof].second == 0.0)
        bounds[dof] = {chi_square_quantile(0.025, step.nis_dof) / step.nis_dof,
                       chi_square_quantile(0.975, step.nis_dof) / step.nis_dof};
      const double nis = step.nis / step.nis_dof;
      innovations.add(time,
                      std::array{nis, bounds[dof].first, bounds[dof].second, mean_nis.add(nis)});
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      const CalibrationValue& value = step.calibration[i];
      row[3 * i] = value.mean;
      row[3 * i + 1] = value.mean - 3.0 * value.sigma;
      row[3 * i + 2] = value.mean + 3.0 * value.sigma;
    }
    if (!names.empty()) calibration.add(time, row);
  }
  if (innovations.size() > 0) {
    Json nis = panel("NIS / dof", "1", innovations, 0);
    nis["band"] = band("95 % of a consistent filter", innovations, 1, 2);
    nis["level"] = {{"name", "ideal mean 1"}, {"value", 1.0}};
    nis["mean"] = channel(innovations, 3, Edge::high);
    nis["log"] = true;
    plots.push_back(
        {{"title", "Innovations (NIS)"},
         {"value", "NIS per degree of freedom"},
         {"good",
          "Divided by its degrees of freedom the squared innovation should average 1 and leave "
          "the band in 5 % of the updates; steadily above it the noise is set too small."},
         {"t", abscissas(innovations)},
         {"panels", Json::array({nis})}});
  }
  if (names.empty()) return;
  Json panels = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    panels.push_back(panel(names[i].c_str(), "", calibration, 3 * i));
    panels[i]["band"] = band("\u00b13\u03c3", calibration, 3 * i + 1, 3 * i + 2);
    if (const auto known = in.truth.calibration.find(names[i]); known != in.truth.calibration.end())
      panels[i]["level"] = {{"name", "true value"}, {"value", known->second}};
  }
  plots.push_back(
      {{"title", "Calibration"},
       {"value", "estimate"},
       {"good",
        "Each parameter should settle while its band shrinks and keeps the true value inside; a "
        "band that never shrinks means that the motion did not excite the parameter."},
       {"t", abscissas(calibration)},
       {"panels", panels}});
}

void add_step_times(Json& plots, const ReportInput& in, const RunAxis& axis) {
  if (in.step_times.size() == 0) return;
  Json t = Json::array();
  for (std::size_t i = 0; i < in.step_times.size(); ++i)
    t.push_back(short_number(axis.at_step(static_cast<std::int64_t>(in.step_times.abscissa(i)))));
  Json times = panel("step time", "ms", in.step_times, 0);
  times["log"] = true;
  plots.push_back(
      {{"title", "Step times"},
       {"value", "time per step"},
       {"good",
        "Flat is good; growth shows the cost of a growing map, single peaks are the machine."},
       {"t", t},
       {"panels", Json::array({times})}});
}

}  // namespace

Json make_report_data(const ReportInput& in) {
  std::optional<TPose2D> placement;
  if (in.summary.truth) placement = in.summary.truth->placement;
  Json data;
  const std::vector<EstimatedPose> path = path_of_point(in.path, in.truth.path.point_on_robot);
  data["map"] = make_map_data(in, path, placement);
  data["plots"] = Json::array();
  const RunAxis axis(in.path);
  if (axis.is_time())
    data["axis"] = {{"name", "time"}, {"unit", "s"}};
  else
    data["axis"] = {{"name", "step"}, {"unit", ""}};
  if (in.path.empty()) return data;
  if (placement)
    add_error_plots(data["plots"], in, path, axis, match_poses(path, in.truth.path), *placement);
  add_filter_plots(data["plots"], in, axis);
  add_step_times(data["plots"], in, axis);
  return data;
}

}  // namespace libslam
