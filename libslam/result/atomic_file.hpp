#pragma once
// Files that are either the old one or the complete new one, never half of it.

#include <filesystem>
#include <functional>
#include <string_view>

namespace libslam {

/// Writes `text` beside `file` and renames it into place. Throws std::runtime_error naming the
/// file; the previous file then still stands.
void replace_file(const std::filesystem::path& file, std::string_view text);

/// The same for a writer that wants a path: `write` gets the temporary name and returns false where
/// it failed. The temporary name ends like `file`. What `write` throws passes through.
void replace_file(const std::filesystem::path& file,
                  const std::function<bool(const std::filesystem::path&)>& write);

}  // namespace libslam
