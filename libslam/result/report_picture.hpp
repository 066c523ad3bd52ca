#pragma once
// Pictures inside the report.

#include <span>
#include <string>

namespace libslam {

struct ReportPicture {
  std::string title;
  std::string png;  ///< the bytes of a PNG file
};

/// Throws std::invalid_argument naming the title where the bytes are not those of a PNG file.
void check_picture(const ReportPicture& picture);

/// The pictures as HTML that holds their bytes.
std::string pictures_html(std::span<const ReportPicture> pictures);

}  // namespace libslam
