#include <filesystem>

#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>

namespace libslam {

void require_input_file(const std::string& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw InputError(file + ": no such file");
  if (std::filesystem::is_directory(status))
    throw InputError(file + ": is a directory, not a file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(file + ": is not a regular file");
  if (std::filesystem::file_size(file, error) == 0) throw InputError(file + ": the file is empty");
}

std::string find_optional_input_file(const std::string& directory, const std::string& name) {
  std::error_code error;
  const std::string plain = (std::filesystem::path(directory) / name).string();
  for (const std::string& file : {plain, plain + ".gz"})
    if (std::filesystem::exists(file, error)) return file;
  return {};
}

std::string find_input_file(const std::string& directory, const std::string& name) {
  std::error_code error;
  if (!std::filesystem::is_directory(directory, error))
    throw InputError(directory + ": is not a directory");
  const std::string file = find_optional_input_file(directory, name);
  if (file.empty())
    throw InputError((std::filesystem::path(directory) / name).string() + ": no such file, nor " +
                     name + ".gz");
  return file;
}

}  // namespace libslam
