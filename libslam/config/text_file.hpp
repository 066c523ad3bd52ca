#pragma once
// Configuration files as text, bounded: they are input like any other.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace libslam {

/// Larger files are no configuration.
inline constexpr std::size_t kMaxConfigBytes = std::size_t{1} << 20;

/// The whole content of `path`.
/// Throws ConfigError if it is missing, a directory, unreadable or longer than kMaxConfigBytes.
std::string read_config_text(const std::filesystem::path& path);

/// `text` in one printable line of at most 60 characters, for error messages.
std::string quote_for_message(std::string_view text);

}  // namespace libslam
