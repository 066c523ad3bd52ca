#pragma once
// Landmark identities of the points of square tags, the same in logs, maps and truth.

#include <cstdint>

namespace libslam {

/// Points of a tag: 0 its centre; 1 top left, 2 top right, 3 bottom right, 4 bottom left corner of
/// the black border, of the upright tag seen from its front.
inline constexpr int kPointsPerTag = 5;
/// Tags of all families have smaller numbers.
inline constexpr std::int64_t kTagPointStride = 100000;

/// The centre of tag 17 is landmark 17, its corner 3 landmark 300017.
constexpr std::int64_t tag_point_id(std::int64_t tag, int point) {
  return kTagPointStride * point + tag;
}

}  // namespace libslam
