#pragma once
// The estimated map: landmarks with their covariance, and map.csv.

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <libslam/data/step_record.hpp>

namespace libslam {

/// Landmarks in the order in which they were added, with unique ids.
class LandmarkMap {
 public:
  LandmarkMap() = default;
  /// Throws like add().
  explicit LandmarkMap(const std::vector<LandmarkEstimate>& landmarks);

  /// Throws std::invalid_argument where the id is taken, the mean is empty or not finite, the
  /// covariance does not match the mean, or the type is empty or holds a comma, a quote or a
  /// control character.
  void add(LandmarkEstimate landmark);

  /// The landmark with this id, or null.
  const LandmarkEstimate* find(std::int64_t id) const;

  const std::vector<LandmarkEstimate>& landmarks() const { return landmarks_; }
  std::size_t size() const { return landmarks_.size(); }
  bool empty() const { return landmarks_.empty(); }
  auto begin() const { return landmarks_.begin(); }
  auto end() const { return landmarks_.end(); }

 private:
  std::vector<LandmarkEstimate> landmarks_;
  std::map<std::int64_t, std::size_t> index_;  // id -> position in landmarks_
};

/// map.csv: `id,type,<mean>,<upper triangle of the covariance, row by row>,times_seen`. With points
/// only the mean is x,y[,z] [m], else mean_1..mean_n of the landmark chart; cells beyond the
/// dimension of a landmark stay empty. Numbers read back bit for bit. Throws std::runtime_error
/// where writing fails.
void write_landmark_map(std::ostream& out, const LandmarkMap& map);

/// Reads what write_landmark_map wrote. `name` stands in messages. Throws std::runtime_error
/// "name:line: ..." on anything else.
LandmarkMap read_landmark_map(std::istream& in, std::string_view name);
/// Throws std::runtime_error naming the file where it cannot be opened.
LandmarkMap read_landmark_map(const std::filesystem::path& file);

}  // namespace libslam
