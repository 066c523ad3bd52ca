#pragma once
// The appearance of an image feature.

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace libslam {

/// Up to 128 bytes: a bit string (ORB, AKAZE; compared by Hamming distance) or a vector of numbers
/// from 0 to 255 (SIFT; compared by Euclidean distance). Bytes beyond `size` are zero.
struct Descriptor {
  enum class Kind : std::uint8_t { kBits, kNumbers };
  Kind kind = Kind::kBits;
  std::uint8_t size = 0;  ///< bytes in use
  std::array<std::uint8_t, 128> bytes{};
};

/// Hamming distance of bit strings, Euclidean distance of numbers; both of one kind and size.
inline double descriptor_distance(const Descriptor& a, const Descriptor& b) {
  int sum = 0;
  for (std::size_t i = 0; i < a.size; ++i) {
    if (a.kind == Descriptor::Kind::kBits) {
      sum += std::popcount(static_cast<unsigned>(a.bytes[i] ^ b.bytes[i]));
    } else {
      const int difference = static_cast<int>(a.bytes[i]) - static_cast<int>(b.bytes[i]);
      sum += difference * difference;
    }
  }
  return a.kind == Descriptor::Kind::kBits ? sum : std::sqrt(static_cast<double>(sum));
}

}  // namespace libslam
