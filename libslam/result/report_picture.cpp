#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <mrpt/system/string_utils.h>

#include <libslam/result/report_html.hpp>
#include <libslam/result/report_picture.hpp>

namespace libslam {
namespace {

std::string base64(const std::string& bytes) {
  std::string text;
  mrpt::system::encodeBase64(std::vector<std::uint8_t>(bytes.begin(), bytes.end()), text);
  std::erase(text, '\n');
  return text;
}

}  // namespace

void check_picture(const ReportPicture& picture) {
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  if (!picture.png.starts_with(kSignature))
    throw std::invalid_argument("picture '" + picture.title + "' is not a PNG file");
}

std::string pictures_html(std::span<const ReportPicture> pictures) {
  std::string html;
  for (const ReportPicture& picture : pictures) {
    const std::string title = escape_html(picture.title);
    html += "<section class=\"plot\"><h2>" + title + "</h2><img class=\"picture\" alt=\"" + title +
            "\" src=\"data:image/png;base64," + base64(picture.png) + "\"></section>\n";
  }
  return html;
}

}  // namespace libslam
