#include <libslam/result/report.hpp>
#include <libslam/result/report_assets.hpp>
#include <libslam/result/report_data.hpp>
#include <libslam/result/report_figures.hpp>
#include <libslam/result/report_html.hpp>

namespace libslam {

std::string make_report(const ReportInput& input, const std::filesystem::path& library_folder) {
  const RunSummary& s = input.summary;
  PageContent page;
  page.title = input.trajectory_csv.parent_path().filename().string();
  page.source = s.input.file.value_or("");
  page.program = s.program + " " + s.version + (s.git.empty() ? "" : " (" + s.git + ")");
  page.cards = key_figures_html(s);
  page.above = warnings_html("Warnings", s.input.warnings);
  page.data = make_report_data(input);
  page.stills = still_drawings_html(page.data);
  page.script = kReportScript;
  page.below = pictures_html(input.pictures);
  page.has_pictures = !input.pictures.empty();
  return assemble_page(page, library_folder);
}

}  // namespace libslam
