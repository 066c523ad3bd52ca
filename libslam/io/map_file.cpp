#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>
#include <libslam/io/map_encoding.hpp>
#include <libslam/io/map_file.hpp>
#include <libslam/io/truth_reader.hpp>
#include <libslam/map/landmark_map.hpp>
#include <libslam/result/atomic_file.hpp>

namespace libslam {
namespace {

using Eigen::Index;

/// Beyond what any map of kLargestMapFile rows can have: its covariance, and 1 KB for each row.
constexpr std::uintmax_t kLargestFile =
    4 * kLargestMapFile * (kLargestMapFile + 1) + 1024 * kLargestMapFile;

LandmarkMap landmarks_of(const SavedMap& map) {
  std::vector<LandmarkEstimate> landmarks;
  Index row = map.landmark_offset();
  for (const SavedLandmark& saved : map.landmarks) {
    Eigen::MatrixXd cov = Eigen::MatrixXd::Zero(map.dimension, map.dimension);
    if (!saved.exact) {
      cov = map.cov.block(row, row, map.dimension, map.dimension);
      row += map.dimension;
    }
    if (saved.confirmed)
      landmarks.push_back({saved.id, saved.type, saved.mean, cov, saved.times_seen, saved.extent});
  }
  std::sort(landmarks.begin(), landmarks.end(),
            [](const LandmarkEstimate& a, const LandmarkEstimate& b) { return a.id < b.id; });
  return LandmarkMap(landmarks);
}

std::string read_whole(const std::string& file) {
  const std::uintmax_t size = std::filesystem::file_size(file);
  if (size > kLargestFile) throw InputError(file + ": is larger than any map");
  std::string bytes(size, '\0');
  std::ifstream in(file, std::ios::binary);
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw InputError(file + ": cannot be read");
  return bytes;
}

std::string beginning_of(const std::string& file) {
  std::string begin(8, '\0');
  std::ifstream(file, std::ios::binary).read(begin.data(), 8);
  return begin;
}

SavedMap read_survey(const std::string& file, double sigma) {
  const auto landmarks = read_true_landmarks(file);
  if (sigma > 0.0 && landmarks.size() > kLargestMapFile / 3)
    throw InputError(file + ": " + std::to_string(landmarks.size()) +
                     " landmarks are too many for a covariance; map.sigma: 0 needs none");
  try {
    return surveyed_map(landmarks, sigma);
  } catch (const std::invalid_argument& error) {
    throw InputError(file + ": " + error.what());
  }
}

}  // namespace

std::filesystem::path map_csv_beside(const std::filesystem::path& file) {
  std::filesystem::path csv = file;
  return csv.replace_extension(".csv");
}

void write_map_file(const std::filesystem::path& file, const SavedMap& map) {
  if (map_csv_beside(file) == file)
    throw std::invalid_argument(file.string() + ": the ending .csv is for the file beside the map");
  const std::string bytes = encode_map(map);
  std::ostringstream csv;
  write_landmark_map(csv, landmarks_of(map));
  replace_file(file, bytes);
  replace_file(map_csv_beside(file), csv.str());
}

SavedMap read_map_file(const std::string& file, double sigma) {
  require_input_file(file);
  const std::string begin = beginning_of(file);
  if (begin.starts_with("id,type,"))
    throw InputError(file +
                     ": is the readable part of a map, without the correlations of its "
                     "landmarks; load the map that --save-map wrote");
  return is_encoded_map(begin) ? decode_map(read_whole(file), file) : read_survey(file, sigma);
}

bool is_saved_map(const std::string& file) {
  return is_encoded_map(beginning_of(file));
}

}  // namespace libslam
