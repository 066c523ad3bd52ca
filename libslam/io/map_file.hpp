#pragma once
// Maps in files: saved by a run, or surveyed by other means.

#include <filesystem>
#include <string>

#include <libslam/map/saved_map.hpp>

namespace libslam {

/// Writes the map (io/map_encoding.hpp), and beside it the confirmed landmarks in the form of
/// map.csv (map/landmark_map.hpp) for people and other programs: X.slammap and X.csv. Each file is
/// either the old one or the complete new one. Throws std::invalid_argument where the map is not
/// sound or `file` ends in .csv, std::runtime_error naming the file where it cannot be written.
void write_map_file(const std::filesystem::path& file, const SavedMap& map);

/// The name of the CSV file beside a map.
std::filesystem::path map_csv_beside(const std::filesystem::path& file);

/// Reads a saved map, or landmarks as read_true_landmarks does (id,x,y[,z]) with `sigma` [m] as
/// surveyed_map does; which of them it is, the content says. Throws InputError.
SavedMap read_map_file(const std::string& file, double sigma);

/// Whether the file is a map that a run saved, so that its frame is the one of that run; surveyed
/// landmarks are in the frame of the survey.
bool is_saved_map(const std::string& file);

}  // namespace libslam
