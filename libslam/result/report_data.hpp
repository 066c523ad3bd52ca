#pragma once
// The numbers behind the plots of the report, already reduced to what a screen can show.

#include <nlohmann/json.hpp>

#include <libslam/result/report.hpp>

namespace libslam {

/// `map`, `side`: see add_map_data. `events`: [{t, what}], if any. `plots`: time series; each has
/// `title`, `value` (what is drawn), `good` (what a good run looks like), `t` (abscissa, see
/// `axis`) and `panels`, each with `label`, `unit`, `low`/`high` (envelope of the value),
/// optionally `band` {name, low, high}, `interval` {name, low, high}, `mean`, `level` {name, value}
/// and `log`. Arrays of a plot have equal lengths; null stands for no value. `axis`: {name, unit}
/// of the abscissa of all plots.
nlohmann::ordered_json make_report_data(const ReportInput& input);

}  // namespace libslam
