#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <mrpt/math/wrap2pi.h>

#include <libslam/result/alignment.hpp>
#include <libslam/result/report_error_plots.hpp>
#include <libslam/result/report_map_data.hpp>
#include <libslam/result/report_series.hpp>
#include <libslam/result/spatial_alignment.hpp>
#include <libslam/result/spatial_metrics.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kErrorsAreGood =
    "A consistent filter keeps the error inside the \u00b13\u03c3 band nearly always, and uses the "
    "band: errors far smaller than it mean a timid covariance.";

/// Errors of N coordinates with three times their sigmas.
template <int N>
class ErrorSeries {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  void add(double time, const Vector& error, const Vector& variance) {
    std::array<double, 3 * N> row;
    for (std::size_t i = 0; i < N; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double bound = 3.0 * std::sqrt(std::max(0.0, variance[k]));
      row[i] = error[k];
      row[N + 2 * i] = -bound;
      row[N + 2 * i + 1] = bound;
    }
    series_.add(time, row);
  }

  /// A plot of the coordinates from `first` on, one per label.
  Json plot(const char* title, const char* unit, std::size_t first,
            const std::vector<const char*>& labels) const {
    Json panels = Json::array();
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const std::size_t k = first + i;
      panels.push_back(panel(labels[i], unit, series_, k));
      panels[i]["band"] = band("\u00b13\u03c3", series_, N + 2 * k, N + 2 * k + 1);
    }
    return {{"title", title},
            {"value", "error"},
            {"good", kErrorsAreGood},
            {"t", abscissas(series_)},
            {"panels", panels}};
  }

 private:
  SeriesEnvelope series_{3 * N, kPlotBuckets};
};

/// `values` of NEES over `times`.
Json nees_plot(const std::vector<double>& times, const std::vector<double>& values, int dof) {
  SeriesEnvelope series(2, kPlotBuckets);
  MovingMean mean(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    series.add(times[i], std::array{values[i], mean.add(values[i])});
  const std::string ideal = std::to_string(dof);
  Json nees = panel("NEES", "1", series, 0);
  nees["interval"] = {{"name", "95 % of a consistent filter"},
                      {"low", short_number(chi_square_quantile(0.025, dof))},
                      {"high", short_number(chi_square_quantile(0.975, dof))}};
  nees["level"] = {{"name", "ideal mean " + ideal}, {"value", static_cast<double>(dof)}};
  nees["mean"] = channel(series, 1, Edge::high);
  nees["log"] = true;
  return {{"title", "Consistency of the pose (NEES)"},
          {"value", "NEES"},
          {"good", "The squared error in units of its covariance should move around " + ideal +
                       " and stay inside the band for 95 % of the steps; above it the filter is "
                       "overconfident."},
          {"t", abscissas(series)},
          {"panels", Json::array({nees})}};
}

std::vector<double> times_of(std::span<const EstimatedPose> path,
                             std::span<const PoseMatch> matches, const RunAxis& axis) {
  std::vector<double> times;
  for (const PoseMatch& match : matches) times.push_back(axis.at(path[match.estimate]));
  return times;
}

void add_planar(Json& plots, const ReportInput& in, const RunAxis& axis,
                const mrpt::math::TPose2D& T_truth_filter) {
  const Trajectory& truth = in.truth.path;
  const std::vector<EstimatedPose> path = path_of_point(in.path.poses, truth.point_on_robot);
  const std::vector<PoseMatch> matches = match_poses(path, truth);
  const std::vector<double> times = times_of(path, matches, axis);
  const mrpt::math::TPose2D T_filter_truth = invert(T_truth_filter);
  ErrorSeries<3> errors;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const EstimatedPose& estimate = path[matches[i].estimate];
    Eigen::Vector3d e =
        estimate.pose - transform_pose(T_filter_truth, truth.poses[matches[i].truth]);
    e.z() = truth.has_heading ? mrpt::math::wrapToPi(e.z()) : kNone;
    errors.add(times[i], e, estimate.cov.diagonal());
  }
  Json plot = errors.plot("Pose error", "m", 0, {"x error", "y error"});
  if (truth.has_heading)
    plot["panels"].push_back(errors.plot("", "rad", 2, {"heading error"})["panels"][0]);
  plots.push_back(std::move(plot));
  if (truth.has_heading)
    plots.push_back(nees_plot(times, pose_nees(path, truth, matches, T_truth_filter), 3));
}

void add_spatial(Json& plots, const ReportInput& in, const RunAxis& axis,
                 const Eigen::Isometry3d& T_truth_filter) {
  const Trajectory truth = comparable_truth(in.path, in.truth.path);
  const auto path = path_of_point(in.path.spatial, truth.point_on_robot);
  const std::vector<PoseMatch> matches = match_poses(in.path.poses, truth);
  const std::vector<double> times = times_of(in.path.poses, matches, axis);
  const Eigen::Isometry3d T_filter_truth = T_truth_filter.inverse();
  ErrorSeries<6> errors;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const SpatialEstimate& estimate = path[matches[i].estimate];
    errors.add(times[i],
               pose_difference(estimate.pose,
                               transform_pose(T_filter_truth, truth.spatial[matches[i].truth])),
               estimate.cov.diagonal());
  }
  plots.push_back(errors.plot("Position error", "m", 0, {"x error", "y error", "z error"}));
  if (!truth.has_heading) return;
  plots.push_back(errors.plot("Rotation error", "rad", 3, {"about x", "about y", "about z"}));
  plots.push_back(nees_plot(times, pose_nees(path, truth, matches, T_truth_filter), 6));
}

}  // namespace

void add_error_plots(Json& plots, const ReportInput& in, const RunAxis& axis) {
  if (!in.summary.truth) return;
  if (in.summary.truth->spatial_placement)
    add_spatial(plots, in, axis, *in.summary.truth->spatial_placement);
  else if (in.summary.truth->placement)
    add_planar(plots, in, axis, *in.summary.truth->placement);
}

}  // namespace libslam
