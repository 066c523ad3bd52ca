#pragma once
// SHA-256 of what a run used, so that a result names its inputs.

#include <filesystem>
#include <string>
#include <string_view>

namespace libslam {

/// Lower-case hexadecimal SHA-256 (FIPS 180-4) of `text`.
std::string sha256_of_text(std::string_view text);

/// The same of a file, read in pieces: memory does not grow with the file.
/// Throws std::runtime_error naming the file if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace libslam
