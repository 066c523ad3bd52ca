#include <bit>
#include <cstring>
#include <limits>
#include <stdexcept>

#include <libslam/config/digest.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/map_encoding.hpp>

namespace libslam {
namespace {

using Eigen::Index;
static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

constexpr std::string_view kMagic("SLAMMAP\0", 8);
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kDigest = 64;
constexpr std::uint8_t kConfirmed = 1, kExact = 2, kExtent = 4, kPriorJudged = 8;
constexpr std::uint8_t kAllFlags = kConfirmed | kExact | kExtent | kPriorJudged;
/// The least bytes of a landmark without its coordinates, and of a parameter.
constexpr std::uint64_t kLeastLandmark = 8 + 4 + 4 + 1 + 1 + 1 + 1 + 1, kLeastParameter = 1 + 1 + 8;

class Writer {
 public:
  template <typename Number>
  void number(Number value) {
    char raw[sizeof(Number)];
    std::memcpy(raw, &value, sizeof(Number));
    bytes_.append(raw, sizeof(Number));
  }
  void numbers(const double* first, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) number(first[i]);
  }
  void numbers(const auto& vector) {
    numbers(vector.data(), static_cast<std::size_t>(vector.size()));
  }
  void word(const std::string& word) {
    if (word.size() > std::numeric_limits<std::uint8_t>::max())
      throw std::invalid_argument("a word of a map has more than 255 bytes: " + word);
    number(static_cast<std::uint8_t>(word.size()));
    bytes_ += word;
  }
  void raw(std::string_view bytes) { bytes_ += bytes; }
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  [[noreturn]] void reject(const std::string& what) const { throw InputError(name_ + ": " + what); }
  std::uint64_t left() const { return bytes_.size() - at_; }
  std::string_view raw(std::size_t count) {
    if (left() < count)
      reject("ends at byte " + std::to_string(bytes_.size()) + ", inside the map");
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  template <typename Number>
  Number number() {
    Number value;
    std::memcpy(&value, raw(sizeof(Number)).data(), sizeof(Number));
    return value;
  }
  void numbers(double* first, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) first[i] = number<double>();
  }
  std::string word() { return std::string(raw(number<std::uint8_t>())); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  const std::string& name_;
};

void write_landmark(Writer& out, const SavedLandmark& landmark) {
  out.number(landmark.id);
  out.number(static_cast<std::uint32_t>(landmark.times_seen));
  out.number(static_cast<std::uint32_t>(landmark.updates));
  out.number(static_cast<std::uint8_t>(
      (landmark.confirmed ? kConfirmed : 0) | (landmark.exact ? kExact : 0) |
      (landmark.extent ? kExtent : 0) | (landmark.prior_judged ? kPriorJudged : 0)));
  out.word(landmark.type);
  out.numbers(landmark.mean);
  const Descriptor nothing;
  const Descriptor& appearance = landmark.appearance ? *landmark.appearance : nothing;
  out.number(static_cast<std::uint8_t>(appearance.kind));
  out.number(appearance.size);
  out.raw({reinterpret_cast<const char*>(appearance.bytes.data()), appearance.size});
  if (const auto& extent = landmark.extent)
    for (const double number : {extent->begin, extent->end, extent->sigma_begin, extent->sigma_end})
      out.number(number);
}

int read_count(Reader& in) {
  const auto count = in.number<std::uint32_t>();
  if (count > static_cast<std::uint32_t>(std::numeric_limits<int>::max()))
    in.reject("a count of sightings is beyond all bounds");
  return static_cast<int>(count);
}

Extent read_extent(Reader& in) {
  Extent extent;
  for (double* number : {&extent.begin, &extent.end, &extent.sigma_begin, &extent.sigma_end})
    *number = in.number<double>();
  return extent;
}

SavedLandmark read_landmark(Reader& in, int dimension) {
  SavedLandmark landmark;
  landmark.id = in.number<std::int64_t>();
  landmark.times_seen = read_count(in);
  landmark.updates = read_count(in);
  const auto flags = in.number<std::uint8_t>();
  if (flags > kAllFlags) in.reject("unknown flags of a landmark");
  landmark.confirmed = (flags & kConfirmed) != 0;
  landmark.exact = (flags & kExact) != 0;
  landmark.prior_judged = (flags & kPriorJudged) != 0;
  landmark.type = in.word();
  landmark.mean.resize(dimension);
  in.numbers(landmark.mean.data(), static_cast<std::size_t>(dimension));
  Descriptor appearance;
  const auto kind = in.number<std::uint8_t>();
  appearance.size = in.number<std::uint8_t>();
  if (kind > static_cast<std::uint8_t>(Descriptor::Kind::kNumbers) ||
      appearance.size > appearance.bytes.size())
    in.reject("landmark " + std::to_string(landmark.id) + ": no such appearance");
  appearance.kind = static_cast<Descriptor::Kind>(kind);
  const std::string_view bytes = in.raw(appearance.size);
  std::memcpy(appearance.bytes.data(), bytes.data(), bytes.size());
  if (appearance.size > 0) landmark.appearance = std::make_shared<Descriptor>(appearance);
  if ((flags & kExtent) != 0) landmark.extent = read_extent(in);
  return landmark;
}

/// What the head of a file says; `rows` of the covariance.
struct Counts {
  std::uint32_t pose = 0, calibration = 0, excitation = 0, landmarks = 0;
  std::uint64_t rows = 0;
};

/// Throws unless the rest of the file can hold what the counts say.
void require_room(const Reader& in, const Counts& counts, int dimension) {
  if (counts.pose != 0 && counts.pose != 3 && counts.pose != 7)
    in.reject("a pose of " + std::to_string(counts.pose) + " numbers");
  if (counts.rows > kLargestMapFile)
    in.reject("a covariance of " + std::to_string(counts.rows) + " rows; at most " +
              std::to_string(kLargestMapFile) + " are read");
  const std::uint64_t least =
      8ull * counts.pose + kLeastParameter * counts.calibration + 8ull * counts.excitation +
      (kLeastLandmark + 8ull * static_cast<std::uint64_t>(dimension)) * counts.landmarks +
      4ull * counts.rows * (counts.rows + 1) + kDigest;
  if (least > in.left())
    in.reject("is too short for the " + std::to_string(counts.landmarks) + " landmarks and " +
              std::to_string(counts.rows) + " rows that it announces");
}

Counts read_head(Reader& in, SavedMap& map) {
  if (in.raw(kMagic.size()) != kMagic) in.reject("is no saved map");
  if (const auto version = in.number<std::uint32_t>(); version != kVersion)
    in.reject("is a map of version " + std::to_string(version) + "; this program reads version " +
              std::to_string(kVersion));
  const auto dimension = in.number<std::uint32_t>();
  if (dimension != 2 && dimension != 3)
    in.reject("landmarks of " + std::to_string(dimension) + " coordinates");
  map.dimension = static_cast<int>(dimension);
  Counts counts;
  counts.pose = in.number<std::uint32_t>();
  counts.calibration = in.number<std::uint32_t>();
  counts.excitation = in.number<std::uint32_t>();
  counts.landmarks = in.number<std::uint32_t>();
  map.next_number = in.number<std::int64_t>();
  counts.rows = in.number<std::uint64_t>();
  require_room(in, counts, map.dimension);
  return counts;
}

void read_body(Reader& in, const Counts& counts, SavedMap& map) {
  map.pose.resize(counts.pose);
  in.numbers(map.pose.data(), counts.pose);
  for (std::uint32_t i = 0; i < counts.calibration; ++i) {
    SavedCalibration& parameter = map.calibration.emplace_back();
    parameter.name = in.word();
    parameter.mean = in.number<double>();
  }
  map.excitation.resize(counts.excitation);
  in.numbers(map.excitation.data(), map.excitation.size());
  for (std::uint32_t i = 0; i < counts.landmarks; ++i)
    map.landmarks.push_back(read_landmark(in, map.dimension));
  // A second time: names and types may have taken the room of the covariance.
  if (in.left() != 4 * counts.rows * (counts.rows + 1) + kDigest)
    in.reject("its length does not fit its " + std::to_string(counts.rows) + " rows");
  const auto rows = static_cast<Index>(counts.rows);
  map.cov.resize(rows, rows);
  for (Index r = 0; r < rows; ++r)
    for (Index c = 0; c <= r; ++c) map.cov(r, c) = map.cov(c, r) = in.number<double>();
}

}  // namespace

std::string encode_map(const SavedMap& map) {
  check_saved_map(map);
  const auto rows = static_cast<std::uint64_t>(map.cov.rows());
  if (rows > kLargestMapFile)
    throw std::invalid_argument("a map of " + std::to_string(rows) + " coordinates; at most " +
                                std::to_string(kLargestMapFile) + " are written");
  Writer out;
  out.raw(kMagic);
  out.number(kVersion);
  out.number(static_cast<std::uint32_t>(map.dimension));
  out.number(static_cast<std::uint32_t>(map.pose.size()));
  out.number(static_cast<std::uint32_t>(map.calibration.size()));
  out.number(static_cast<std::uint32_t>(map.excitation.size()));
  out.number(static_cast<std::uint32_t>(map.landmarks.size()));
  out.number(map.next_number);
  out.number(rows);
  out.numbers(map.pose);
  for (const SavedCalibration& parameter : map.calibration) {
    out.word(parameter.name);
    out.number(parameter.mean);
  }
  out.numbers(map.excitation);
  for (const SavedLandmark& landmark : map.landmarks) write_landmark(out, landmark);
  for (Index r = 0; r < map.cov.rows(); ++r)
    for (Index c = 0; c <= r; ++c) out.number(map.cov(r, c));
  out.raw(sha256_of_text(out.bytes()));
  return std::move(out.bytes());
}

bool is_encoded_map(std::string_view bytes) {
  return bytes.starts_with(kMagic);
}

SavedMap decode_map(std::string_view bytes, const std::string& name) {
  Reader in(bytes, name);
  SavedMap map;
  const Counts counts = read_head(in, map);
  if (sha256_of_text(bytes.substr(0, bytes.size() - kDigest)) !=
      bytes.substr(bytes.size() - kDigest))
    in.reject("is damaged: its content does not have the digest at its end");
  read_body(in, counts, map);
  try {
    check_saved_map(map);
  } catch (const std::invalid_argument& error) {
    in.reject(error.what());
  }
  return map;
}

}  // namespace libslam
