#pragma once
// The appearance of an image feature.

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

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

/// Distance on a scale from 0, the same, to about 1: share of the bits that differ, or Euclidean
/// distance over 512, the length that OpenCV gives a SIFT vector. Infinite where the two cannot be
/// compared.
inline double relative_distance(const Descriptor& a, const Descriptor& b) {
  if (a.kind != b.kind || a.size != b.size || a.size == 0)
    return std::numeric_limits<double>::infinity();
  const double largest = a.kind == Descriptor::Kind::kBits ? 8.0 * a.size : 512.0;
  return descriptor_distance(a, b) / largest;
}

}  // namespace libslam
