#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include <libslam/result/atomic_file.hpp>

namespace libslam {

void replace_file(const std::filesystem::path& file, std::string_view text) {
  replace_file(file, [text](const std::filesystem::path& temporary) {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    return out.good();
  });
}

void replace_file(const std::filesystem::path& file,
                  const std::function<bool(const std::filesystem::path&)>& write) {
  const auto temporary = file.parent_path() / (".new-" + file.filename().string());
  std::error_code ignored;
  errno = 0;
  bool written = false;
  try {
    written = write(temporary);
  } catch (...) {
    std::filesystem::remove(temporary, ignored);
    throw;
  }
  if (!written) {
    const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
    std::filesystem::remove(temporary, ignored);
    throw std::runtime_error("cannot write " + file.string() + reason);
  }
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (error) {
    std::filesystem::remove(temporary, ignored);
    throw std::runtime_error("cannot write " + file.string() + ": " + error.message());
  }
}

}  // namespace libslam
