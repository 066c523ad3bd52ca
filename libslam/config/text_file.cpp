#include <fstream>
#include <system_error>

#include <libslam/config/config_error.hpp>
#include <libslam/config/text_file.hpp>

namespace libslam {

std::string read_config_text(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    throw ConfigError(path.string() + ": no such file");
  }
  if (std::filesystem::is_directory(path, ignored)) {
    throw ConfigError(path.string() + ": is a directory, a configuration file is expected");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw ConfigError(path.string() + ": cannot be opened for reading");
  }
  // The size is found by reading, because pipes and device files have none.
  std::string text(kMaxConfigBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) {
    throw ConfigError(path.string() + ": cannot be read");
  }
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMaxConfigBytes) {
    throw ConfigError(path.string() + ": larger than " + std::to_string(kMaxConfigBytes) +
                      " bytes, this is not a configuration file");
  }
  return text;
}

std::string quote_for_message(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::size_t end = text.size();
  if (end > kLongest) {
    end = kLongest;
    // Never cut inside a UTF-8 character: step back over continuation bytes.
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
      --end;
    }
  }
  std::string line = "'";
  for (const char c : text.substr(0, end)) {
    const auto byte = static_cast<unsigned char>(c);
    line += (byte < 0x20 || byte == 0x7F) ? '?' : c;
  }
  return line + (end < text.size() ? "...'" : "'");
}

}  // namespace libslam
