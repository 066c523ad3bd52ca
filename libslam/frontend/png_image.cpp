#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <png.h>
#include <vector>

#include <libslam/frontend/png_image.hpp>

namespace libslam {

namespace {

/// libpng's image with its life.
class Reader {
 public:
  Reader() {
    std::memset(&image_, 0, sizeof image_);
    image_.version = PNG_IMAGE_VERSION;
  }
  ~Reader() { png_image_free(&image_); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  png_image* operator->() { return &image_; }
  png_image* get() { return &image_; }
  /// Throws what libpng says went wrong.
  void require(int success) const {
    if (success == 0) throw DamagedPng(std::string("PNG: ") + image_.message);
  }

 private:
  png_image image_;
};

}  // namespace

bool is_png_name(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".png";
}

cv::Mat read_png(const std::string& file, int largest) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) throw DamagedPng("no such file");
  Reader reader;
  reader.require(png_image_begin_read_from_file(reader.get(), file.c_str()));
  const auto most = static_cast<png_uint_32>(largest);
  if (reader->width > most || reader->height > most)
    throw DamagedPng(std::to_string(reader->width) + " x " + std::to_string(reader->height) +
                     " pixels are too many");
  const bool colour = (reader->format & PNG_FORMAT_FLAG_COLOR) != 0;
  // With the channel of transparency, which libpng would mix with a background otherwise.
  reader->format = colour ? PNG_FORMAT_BGRA : PNG_FORMAT_GA;
  cv::Mat pixels(static_cast<int>(reader->height), static_cast<int>(reader->width),
                 colour ? CV_8UC4 : CV_8UC2);
  reader.require(png_image_finish_read(reader.get(), nullptr, pixels.data,
                                       static_cast<png_int_32>(pixels.step), nullptr));
  cv::Mat visible(pixels.size(), colour ? CV_8UC3 : CV_8UC1);
  const std::vector<int> channels =
      colour ? std::vector<int>{0, 0, 1, 1, 2, 2} : std::vector<int>{0, 0};
  cv::mixChannels({pixels}, {visible}, channels);
  return visible;
}

}  // namespace libslam
