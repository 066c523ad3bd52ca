#include <cstdio>

#include <libslam/result/report_html.hpp>

namespace libslam {

std::string escape_html(std::string_view text) {
  std::string safe;
  for (const char c : text) switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  return safe;
}

std::string format_figure(double value, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%.4g", value);
  return *unit != '\0' ? std::string(text) + "\u202f" + unit : text;
}

Card::Card(const char* title)
    : html_(std::string("<section class=\"card\"><h3>") + title + "</h3><dl>") {}

Card& Card::row(std::string_view name, const std::string& value) {
  html_ += "<div><dt>" + escape_html(name) + "</dt><dd>" + escape_html(value) + "</dd></div>";
  ++rows_;
  return *this;
}

Card& Card::row(const char* name, const std::optional<double>& value, const char* unit,
                double factor) {
  return value ? row(name, format_figure(*value * factor, unit)) : *this;
}

std::string Card::html() const {
  return rows_ > 0 ? html_ + "</dl></section>\n" : "";
}

std::string warnings_html(const char* title, const std::vector<std::string>& warnings) {
  if (warnings.empty()) return "";
  std::string html = std::string("<section class=\"warnings\"><h2>") + title + "</h2><ul>";
  for (const std::string& warning : warnings) html += "<li>" + escape_html(warning) + "</li>";
  return html + "</ul></section>\n";
}

}  // namespace libslam
