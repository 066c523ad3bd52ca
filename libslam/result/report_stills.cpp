// Still drawings: the same data as the interactive plots, for a page written without the plotting
// library.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <libslam/result/report_figures.hpp>
#include <libslam/result/report_html.hpp>

namespace libslam {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kWidth = 960.0;

struct Interval {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(const Json& value) {
    if (!value.is_number()) return;
    low = std::min(low, value.get<double>());
    high = std::max(high, value.get<double>());
  }
  void add_all(const Json& values) {
    for (const Json& value : values) add(value);
  }
  double width() const { return std::max(high - low, 1e-12); }
};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

std::string label(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string open_svg(double height) {
  return "<svg viewBox=\"0 0 " + number(kWidth) + " " + number(height) + "\" role=\"img\">";
}

std::string polyline(const Json& xs, const Json& ys, const char* css_class, auto&& to_x,
                     auto&& to_y) {
  std::string points;
  for (std::size_t i = 0; i < xs.size(); ++i)
    if (xs[i].is_number() && ys[i].is_number())
      points += number(to_x(xs[i].template get<double>())) + "," +
                number(to_y(ys[i].template get<double>())) + " ";
  return std::string("<polyline class=\"") + css_class + "\" points=\"" + points + "\"/>";
}

std::string wall_line(const Json& wall, auto&& to_x, auto&& to_y) {
  return "<line class=\"wall\" x1=\"" + number(to_x(wall[0].get<double>())) + "\" y1=\"" +
         number(to_y(wall[1].get<double>())) + "\" x2=\"" + number(to_x(wall[2].get<double>())) +
         "\" y2=\"" + number(to_y(wall[3].get<double>())) + "\"/>";
}

std::string corner_label(double x, double y, const std::string& text,
                         const char* anchor = "start") {
  return "<text class=\"tick\" text-anchor=\"" + std::string(anchor) + "\" x=\"" + number(x) +
         "\" y=\"" + number(y) + "\">" + escape_html(text) + "</text>";
}

/// `vertical`: name of the axis that `y` of the map is drawn along.
std::string map_drawing(const Json& map, const std::string& vertical) {
  Interval x, y;
  for (const char* path : {"path", "truth"}) {
    x.add_all(map[path]["x"]);
    y.add_all(map[path]["y"]);
  }
  for (const char* points : {"landmarks", "true_landmarks"})
    for (const Json& point : map[points]) {
      x.add(point[0]);
      y.add(point[1]);
    }
  if (map.contains("walls"))
    for (const Json& wall : map["walls"])
      for (const std::size_t end : {0, 2}) {
        x.add(wall[end]);
        y.add(wall[end + 1]);
      }
  if (!(x.high >= x.low) || !(y.high >= y.low)) return "";
  const double scale = std::min((kWidth - 20.0) / x.width(), 600.0 / y.width());
  const double height = y.width() * scale + 40.0;
  const auto to_x = [&](double v) { return 0.5 * kWidth + (v - 0.5 * (x.low + x.high)) * scale; };
  const auto to_y = [&](double v) { return height - 30.0 - (v - y.low) * scale; };
  std::string svg = open_svg(height);
  svg += polyline(map["truth"]["x"], map["truth"]["y"], "truth-line", to_x, to_y);
  svg += polyline(map["path"]["x"], map["path"]["y"], "estimate-line", to_x, to_y);
  if (map.contains("smoothed"))
    svg += polyline(map["smoothed"]["x"], map["smoothed"]["y"], "smoothed-line", to_x, to_y);
  if (map.contains("walls"))
    for (const Json& wall : map["walls"]) svg += wall_line(wall, to_x, to_y);
  const auto add_dots = [&](const char* key, const char* css_class, double radius) {
    for (const Json& point : map[key])
      svg += std::string("<circle class=\"") + css_class + "\" r=\"" + number(radius) + "\" cx=\"" +
             number(to_x(point[0].get<double>())) + "\" cy=\"" +
             number(to_y(point[1].get<double>())) + "\"/>";
  };
  add_dots("true_landmarks", "truth-dot", 4.5);
  add_dots("landmarks", "estimate-dot", 2.5);
  svg += corner_label(10.0, height - 8.0,
                      "x " + label(x.low) + " \u2026 " + label(x.high) + " m, " + vertical + " " +
                          label(y.low) + " \u2026 " + label(y.high) +
                          " m; estimate blue, truth orange");
  return svg + "</svg>";
}

}  // namespace

std::string still_panel_svg(const Json& axis, const Json& t, const Json& panel) {
  constexpr double kHeight = 170.0, kLeft = 70.0;
  Interval x, y;
  x.add_all(t);
  y.add_all(panel["low"]);
  y.add_all(panel["high"]);
  if (!(x.high >= x.low) || !(y.high >= y.low)) return "";
  const auto to_x = [&](double v) {
    return kLeft + (v - x.low) / x.width() * (kWidth - kLeft - 10.0);
  };
  const auto to_y = [&](double v) {
    return kHeight - 25.0 - (std::clamp(v, y.low, y.high) - y.low) / y.width() * (kHeight - 45.0);
  };
  std::string svg = open_svg(kHeight);
  for (const char* edge : {"low", "high"}) {
    if (panel.contains("band")) svg += polyline(t, panel["band"][edge], "band-line", to_x, to_y);
    svg += polyline(t, panel[edge], "estimate-line", to_x, to_y);
  }
  const std::string unit = panel["unit"].get<std::string>();
  svg += corner_label(kLeft, 14.0,
                      panel["label"].get<std::string>() + (unit.empty() ? "" : " [" + unit + "]"));
  svg += corner_label(kLeft - 6.0, 28.0, label(y.high), "end");
  svg += corner_label(kLeft - 6.0, kHeight - 25.0, label(y.low), "end");
  svg += corner_label(
      kLeft, kHeight - 6.0,
      axis["name"].get<std::string>() + " " + label(x.low) + " " + axis["unit"].get<std::string>());
  svg += corner_label(kWidth - 10.0, kHeight - 6.0,
                      label(x.high) + " " + axis["unit"].get<std::string>(), "end");
  return svg + "</svg>";
}

std::string still_drawings_html(const Json& data) {
  std::string html = "<section class=\"plot\"><h2>Path and map</h2>" +
                     map_drawing(data["map"], "y") + "</section>\n";
  if (data.contains("side"))
    html += "<section class=\"plot\"><h2>From the side</h2>" + map_drawing(data["side"], "z") +
            "</section>\n";
  for (const Json& plot : data["plots"]) {
    html += "<section class=\"plot\"><h2>" + escape_html(plot["title"].get<std::string>()) +
            "</h2><p class=\"good\">" + escape_html(plot["good"].get<std::string>()) + "</p>";
    for (const Json& panel : plot["panels"])
      html += still_panel_svg(data["axis"], plot["t"], panel);
    html += "</section>\n";
  }
  return html;
}

}  // namespace libslam
