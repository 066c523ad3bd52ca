#pragma once
// The checks that every input file passes before anything is read from it.

#include <string>

namespace libslam {

/// Throws InputError unless `file` is an existing, regular file with content.
void require_input_file(const std::string& file);

/// `directory`/`name`, or the same with ".gz" where only that exists. Throws InputError if neither
/// does, or if `directory` is not a directory.
std::string find_input_file(const std::string& directory, const std::string& name);

/// The same for a file that need not be there; empty if it is not.
std::string find_optional_input_file(const std::string& directory, const std::string& name);

}  // namespace libslam
