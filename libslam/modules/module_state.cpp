#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <exception>
#include <string>
#include <string_view>

#include <mrpt/serialization/CArchive.h>

#include <libslam/config/digest.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/map_encoding.hpp>
#include <libslam/modules/module_state.hpp>

namespace libslam {

namespace {

using mrpt::serialization::CArchive;
static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

constexpr std::string_view kMagic = "SLAMSTATE1";
constexpr const char* kName = "saved state";
constexpr std::size_t kDigest = 64;

/// Steps and clock, as they stand in the archive.
struct Head {
  std::int64_t steps = 0;
  double time = 0.0, motion_time = 0.0;
  std::uint8_t any_step = 0, any_motion = 0;

  static constexpr std::size_t kBytes = 8 + 8 + 8 + 1 + 1;
  template <typename Visitor>
  void visit(Visitor visitor) {
    visitor(&steps, sizeof steps);
    visitor(&time, sizeof time);
    visitor(&motion_time, sizeof motion_time);
    visitor(&any_step, sizeof any_step);
    visitor(&any_motion, sizeof any_motion);
  }
};

[[noreturn]] void reject(const std::string& what) {
  throw InputError(std::string(kName) + ": " + what);
}

/// So many bytes, read in parts: a count that is wrong allocates no more than what comes.
std::string read_bytes(CArchive& in, std::uint64_t count) {
  constexpr std::uint64_t kPart = 1 << 20;
  std::string bytes;
  try {
    while (bytes.size() < count) {
      const std::size_t before = bytes.size();
      bytes.resize(before + std::min(kPart, count - before));
      const std::size_t wanted = bytes.size() - before;
      if (in.ReadBuffer(bytes.data() + before, wanted) != wanted) reject("ends early");
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception&) {  // MRPT's own has a page of text
    reject("ends early");
  }
  return bytes;
}

ModuleState decode(std::string_view bytes) {
  ModuleState state;
  Head head;
  const char* at = bytes.data();
  head.visit([&](void* field, std::size_t size) {
    std::memcpy(field, at, size);
    at += size;
  });
  if (head.steps < 0 || !std::isfinite(head.time) || !std::isfinite(head.motion_time) ||
      head.any_step > 1 || head.any_motion > 1)
    reject("its clock is none");
  state.steps = head.steps;
  state.clock.any_step = head.any_step == 1;
  state.clock.time = head.time;
  if (head.any_motion == 1) state.clock.motion_time = head.motion_time;
  state.map = decode_map(bytes.substr(Head::kBytes), kName);
  return state;
}

}  // namespace

void write_state(CArchive& out, const ModuleState& state) {
  const auto& clock = state.clock;
  Head head{state.steps, clock.time, clock.motion_time.value_or(0.0),
            static_cast<std::uint8_t>(clock.any_step),
            static_cast<std::uint8_t>(clock.motion_time.has_value())};
  std::string bytes;
  head.visit([&](const void* field, std::size_t size) {
    bytes.append(static_cast<const char*>(field), size);
  });
  bytes += encode_map(state.map);
  bytes += sha256_of_text(bytes);
  const auto count = static_cast<std::uint64_t>(bytes.size());
  out.WriteBuffer(kMagic.data(), kMagic.size());
  out.WriteBuffer(&count, sizeof count);
  out.WriteBuffer(bytes.data(), bytes.size());
}

ModuleState read_state(CArchive& in) {
  if (read_bytes(in, kMagic.size()) != kMagic) reject("is none, or of another version");
  std::uint64_t count = 0;
  std::memcpy(&count, read_bytes(in, sizeof count).data(), sizeof count);
  if (count < Head::kBytes + kDigest) reject("is too short");
  const std::string bytes = read_bytes(in, count);
  const std::string_view content = std::string_view(bytes).substr(0, count - kDigest);
  if (sha256_of_text(content) != bytes.substr(count - kDigest))
    reject("is damaged: its content does not have the digest at its end");
  return decode(content);
}

}  // namespace libslam
