#pragma once
// The numbers behind the plots of a campaign's report, reduced to what a screen can show.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace libslam {

/// "a = 1, b = 2" for the settings of a grid point, "a = b = 1" where all have one value. The last
/// part of each key stands for it unless two keys share it. Empty for a campaign without grid.
std::string point_label(const nlohmann::ordered_json& point);

/// Ascending indices of at most `limit` (>= 2) values: all of them, or the least and the greatest
/// of each of limit / 2 equal stretches. Values that are no numbers count for nothing.
std::vector<std::size_t> extreme_indices(std::span<const double> values, std::size_t limit);

/// `variants`: names. `grid`: {name, values}, `values` null where the points are no numbers on one
/// axis; null without grid. `points`: {label, cells}, a cell per variant, null where there is none:
/// `done`, `runs`; `nees` {t [s], mean, lower, upper, runs}; `errors`, for x [m], y [m] and heading
/// [deg] of the example run: {t [s], error, bound} with bound = 3 sigma; `boxes` {position [m],
/// heading [deg], nees}: least, 5 %, quartile, median, quartile, 95 %, greatest of the runs;
/// `ratio` {value, lower, upper} of the position RMSE to the reference; `nees_mean`. `seed` of the
/// example run and `curves`, false where the campaign has too many cells for them.
nlohmann::ordered_json make_campaign_report_data(const nlohmann::ordered_json& campaign);

}  // namespace libslam
