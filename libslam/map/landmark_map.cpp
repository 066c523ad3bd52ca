#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <span>
#include <stdexcept>

#include <libslam/map/csv_text.hpp>
#include <libslam/map/landmark_map.hpp>

namespace libslam {
namespace {

using Eigen::Index;

constexpr Index kMaxDimension = 6;
constexpr std::array<const char*, 3> kPointAxes = {"x", "y", "z"};

constexpr std::array<const char*, 4> kExtentColumns = {"begin", "end", "sigma_begin", "sigma_end"};

/// The columns of a map.csv.
struct Layout {
  Index dimension = 0;
  bool extents = false;  ///< where any landmark has one
};

Index cells_of(const Layout& layout) {
  const Index n = layout.dimension;
  return 3 + n + n * (n + 1) / 2 + (layout.extents ? Index{kExtentColumns.size()} : 0);
}

bool is_plain_word(const std::string& type) {
  return !type.empty() && std::none_of(type.begin(), type.end(), [](unsigned char c) {
    return c < ' ' || c == ',' || c == '"' || c == 127;
  });
}

void check(const LandmarkEstimate& landmark) {
  const std::string who = "landmark " + std::to_string(landmark.id) + ": ";
  const Index n = landmark.mean.size();
  if (n < 1 || n > kMaxDimension)
    throw std::invalid_argument(who + "mean has " + std::to_string(n) + " entries");
  if (landmark.cov.rows() != n || landmark.cov.cols() != n)
    throw std::invalid_argument(who + "covariance is " + std::to_string(landmark.cov.rows()) +
                                " x " + std::to_string(landmark.cov.cols()) + ", mean has " +
                                std::to_string(n) + " entries");
  if (!landmark.mean.allFinite() || !landmark.cov.allFinite())
    throw std::invalid_argument(who + "mean or covariance is not finite");
  if (!is_plain_word(landmark.type)) throw std::invalid_argument(who + "type is not a plain word");
}

Layout layout_of(const LandmarkMap& map) {
  Layout layout{2, false};
  for (const LandmarkEstimate& landmark : map) {
    layout.dimension = std::max(layout.dimension, landmark.mean.size());
    layout.extents = layout.extents || landmark.extent;
  }
  return layout;
}

std::string header(const LandmarkMap& map, const Layout& layout) {
  const Index dimension = layout.dimension;
  const bool points =
      dimension <= Index{kPointAxes.size()} &&
      std::all_of(map.begin(), map.end(), [](const auto& l) { return l.type == "point"; });
  const auto axis = [points](Index i) {
    return points ? std::string(kPointAxes[static_cast<std::size_t>(i)]) : std::to_string(i + 1);
  };
  std::string line = "id,type";
  for (Index i = 0; i < dimension; ++i) line += (points ? "," : ",mean_") + axis(i);
  for (Index i = 0; i < dimension; ++i)
    for (Index j = i; j < dimension; ++j) line += ",cov_" + axis(i) + axis(j);
  line += ",times_seen";
  if (layout.extents)
    for (const char* column : kExtentColumns) line += std::string(",") + column;
  return line + '\n';
}

std::string row(const LandmarkEstimate& landmark, const Layout& layout) {
  const Index dimension = layout.dimension;
  std::string line;
  append_number(line, landmark.id);
  line += ',' + landmark.type;
  const Index n = landmark.mean.size();
  for (Index i = 0; i < dimension; ++i) {
    line += ',';
    if (i < n) append_number(line, landmark.mean(i));
  }
  for (Index i = 0; i < dimension; ++i)
    for (Index j = i; j < dimension; ++j) {
      line += ',';
      if (j < n) append_number(line, landmark.cov(i, j));
    }
  line += ',';
  append_number(line, landmark.times_seen);
  const Extent extent = landmark.extent.value_or(Extent{});
  if (layout.extents)
    for (const double number : {extent.begin, extent.end, extent.sigma_begin, extent.sigma_end}) {
      line += ',';
      if (landmark.extent) append_number(line, number);
    }
  return line + '\n';
}

Layout layout_of_header(const std::vector<std::string_view>& cells, TextPlace place) {
  const bool extents = !cells.empty() && cells.back() == kExtentColumns.back();
  const std::size_t beside = extents ? kExtentColumns.size() : 0;
  if (cells.size() >= 3 + beside && cells[0] == "id" && cells[1] == "type" &&
      cells[cells.size() - beside - 1] == "times_seen")
    for (Index n = 1; n <= kMaxDimension; ++n)
      if (cells_of({n, extents}) == static_cast<Index>(cells.size())) return {n, extents};
  throw_at(place, "not the header of a map.csv");
}

Extent parse_extent(std::span<const std::string_view> cells, TextPlace place) {
  const Extent extent{parse_number(cells[0], place), parse_number(cells[1], place),
                      parse_number(cells[2], place), parse_number(cells[3], place)};
  if (extent.begin > extent.end) throw_at(place, "an extent ends before it begins");
  return extent;
}

LandmarkEstimate parse_row(const std::vector<std::string_view>& cells, const Layout& layout,
                           TextPlace place) {
  const Index dimension = layout.dimension;
  if (static_cast<Index>(cells.size()) != cells_of(layout))
    throw_at(place, "expected " + std::to_string(cells_of(layout)) + " cells, found " +
                        std::to_string(cells.size()));
  LandmarkEstimate landmark;
  landmark.id = parse_integer(cells[0], place);
  landmark.type = cells[1];
  Index n = 0;
  while (n < dimension && !cells[static_cast<std::size_t>(2 + n)].empty()) ++n;
  landmark.mean.resize(n);
  landmark.cov.resize(n, n);
  auto cell = cells.begin() + 2;
  for (Index i = 0; i < dimension; ++i, ++cell)
    if (i < n) landmark.mean(i) = parse_number(*cell, place);
  for (Index i = 0; i < dimension; ++i)
    for (Index j = i; j < dimension; ++j, ++cell)
      if (j < n) landmark.cov(i, j) = landmark.cov(j, i) = parse_number(*cell, place);
  landmark.times_seen = static_cast<int>(
      std::clamp<std::int64_t>(parse_integer(*cell, place), 0, std::numeric_limits<int>::max()));
  if (layout.extents && !cells.back().empty())
    landmark.extent = parse_extent(std::span(cells).last(kExtentColumns.size()), place);
  return landmark;
}

}  // namespace

LandmarkMap::LandmarkMap(const std::vector<LandmarkEstimate>& landmarks) {
  for (const LandmarkEstimate& landmark : landmarks) add(landmark);
}

void LandmarkMap::add(LandmarkEstimate landmark) {
  check(landmark);
  if (!index_.emplace(landmark.id, landmarks_.size()).second)
    throw std::invalid_argument("landmark " + std::to_string(landmark.id) + " exists already");
  landmarks_.push_back(std::move(landmark));
}

const LandmarkEstimate* LandmarkMap::find(std::int64_t id) const {
  const auto found = index_.find(id);
  return found == index_.end() ? nullptr : &landmarks_[found->second];
}

void write_landmark_map(std::ostream& out, const LandmarkMap& map) {
  const Layout layout = layout_of(map);
  out << header(map, layout);
  for (const LandmarkEstimate& landmark : map) out << row(landmark, layout);
  if (!out) throw std::runtime_error("writing the landmark map failed");
}

LandmarkMap read_landmark_map(std::istream& in, std::string_view name) {
  LandmarkMap map;
  std::string line;
  std::vector<std::string_view> cells;
  TextPlace place{name, 0};
  Layout layout;
  while (std::getline(in, line)) {
    ++place.line;
    split_cells(line, cells);
    if (place.line == 1) {
      layout = layout_of_header(cells, place);
      continue;
    }
    try {
      map.add(parse_row(cells, layout, place));
    } catch (const std::invalid_argument& error) {
      throw_at(place, error.what());
    }
  }
  if (place.line == 0) throw_at({name, 1}, "empty file");
  return map;
}

LandmarkMap read_landmark_map(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot open " + file.string());
  return read_landmark_map(in, file.string());
}

}  // namespace libslam
