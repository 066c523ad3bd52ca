#include <libslam/result/report_data.hpp>
#include <libslam/result/report_error_plots.hpp>
#include <libslam/result/report_filter_plots.hpp>
#include <libslam/result/report_map_data.hpp>
#include <libslam/result/report_series.hpp>
#include <libslam/result/run_axis.hpp>

namespace libslam {
namespace {

using Json = nlohmann::ordered_json;

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
  Json data;
  add_map_data(data, in);
  data["plots"] = Json::array();
  const RunAxis axis(in.path.poses);
  if (axis.is_time())
    data["axis"] = {{"name", "time"}, {"unit", "s"}};
  else
    data["axis"] = {{"name", "step"}, {"unit", ""}};
  if (in.path.poses.empty()) return data;
  for (const RunEvent& event : in.summary.health.events)
    data["events"].push_back(
        {{"t", short_number(axis.at(event.step, event.time))}, {"what", event.what}});
  add_error_plots(data["plots"], in, axis);
  add_filter_plots(data["plots"], in, axis);
  add_step_times(data["plots"], in, axis);
  return data;
}

}  // namespace libslam
