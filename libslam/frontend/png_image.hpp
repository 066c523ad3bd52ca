#pragma once
// PNG files. OpenCV's reader, and the library below it, write what they dislike to the standard
// error of the process; this one says it to the caller.

#include <stdexcept>
#include <string>

#include <opencv2/core.hpp>

namespace libslam {

/// A file that is no whole PNG; `what()` says why, without the name of the file.
class DamagedPng : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The name ends with .png, in capitals or not.
bool is_png_name(const std::string& file);

/// 8 bit, one channel of gray values or three of colours (blue, green, red); transparency is left
/// out. Throws DamagedPng where the file cannot be read, is damaged, or is larger than `largest`
/// pixels along a side.
cv::Mat read_png(const std::string& file, int largest = 16384);

}  // namespace libslam
