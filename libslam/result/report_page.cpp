#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>

#include <libslam/result/report_assets.hpp>
#include <libslam/result/report_html.hpp>
#include <libslam/result/report_page.hpp>

namespace libslam {
namespace {

constexpr const char* kInstallHint =
    "<p class=\"hint\">The plots on this page are still drawings because the plotting library was "
    "not found when "
    "the page was written. Install the package <code>libjs-d3</code>, or let "
    "<code>LIBSLAM_JS_DIR</code> name a "
    "folder with <code>d3.min.js</code>, and write the report again.</p>\n";

/// The library as text that can stand in a script element, or nothing.
std::optional<std::string> read_library(const std::filesystem::path& folder) {
  for (const char* name : {"d3/d3.min.js", "d3.min.js"}) {
    std::ifstream in(folder / name, std::ios::binary);
    if (!in) continue;
    std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!text.empty() && text.find("</script") == std::string::npos) return text;
  }
  return std::nullopt;
}

/// JSON that can stand in a script element: no "</script" and no "<!--" can occur in it.
std::string embeddable(const nlohmann::ordered_json& data) {
  const std::string text =
      data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) c == '<' ? safe += "\\u003c" : safe += c;
  return safe;
}

/// Replaces each `{{name}}` of the template once; what is put in is not looked at again.
std::string fill_template(std::string_view page,
                          const std::map<std::string_view, std::string>& parts) {
  std::string result;
  for (;;) {
    const std::size_t open = page.find("{{");
    const std::size_t close = page.find("}}", open);
    if (close == std::string_view::npos) return result.append(page);
    result.append(page.substr(0, open));
    result += parts.at(page.substr(open + 2, close - open - 2));
    page.remove_prefix(close + 2);
  }
}

}  // namespace

std::filesystem::path plotting_library_folder() {
  const char* folder = std::getenv("LIBSLAM_JS_DIR");
  return folder != nullptr && *folder != '\0' ? folder : LIBSLAM_DEFAULT_JS_DIR;
}

std::string assemble_page(const PageContent& content, const std::filesystem::path& library_folder) {
  const std::optional<std::string> library = read_library(library_folder);
  std::string scripts;
  if (library)
    scripts = "<script>" + *library + "</script>\n<script type=\"application/json\" id=\"data\">" +
              embeddable(content.data) + "</script>\n<script>" + std::string(kReportParts) +
              std::string(content.script) + "</script>";
  const std::string plots =
      library ? std::string("<main id=\"plots\"></main>\n") : kInstallHint + content.stills;
  return fill_template(kReportPage, {{"title", escape_html(content.title)},
                                     {"policy", content.has_pictures ? "; img-src data:" : ""},
                                     {"style", std::string(kReportStyle) + content.style},
                                     {"source", escape_html(content.source)},
                                     {"program", escape_html(content.program)},
                                     {"figures", content.cards},
                                     {"body", content.above + plots + content.below},
                                     {"scripts", scripts}});
}

}  // namespace libslam
