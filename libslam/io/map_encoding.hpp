#pragma once
// The binary form of a saved map, version 1. Little endian, no padding.
//
// | bytes       | content                                                                       |
// |-------------|-------------------------------------------------------------------------------|
// | 8           | "SLAMMAP" and a zero byte                                                     |
// | 4 x 6       | version, dimension, numbers of the pose (0, 3, 7), calibration parameters,    |
// |             | numbers of the excitation, landmarks; unsigned                                |
// | 8, 8        | next running number; rows n of the covariance                                 |
// | 8 each      | numbers of the pose                                                           |
// | variable    | parameters: length of the name (1 byte), name, mean (8)                       |
// | 8 each      | numbers of the excitation                                                     |
// | variable    | landmarks: id (8), times seen (4), updates (4), flags (1: confirmed 1,        |
// |             | exact 2), length of the type (1), type, mean (8 x dimension), kind (1) and    |
// |             | length (1) of the appearance, its bytes                                       |
// | 8 n(n+1)/2  | covariance: lower triangle, row by row                                        |
// | 64          | SHA-256 of everything before, in lower-case hexadecimal digits                |

#include <string>
#include <string_view>

#include <libslam/map/saved_map.hpp>

namespace libslam {

/// Most rows that a map file may have: a covariance of 1.6 GB in the file.
inline constexpr std::uint64_t kLargestMapFile = 20000;

/// Throws std::invalid_argument like check_saved_map, and if a name or a type is longer than 255
/// bytes or there are more rows than kLargestMapFile.
std::string encode_map(const SavedMap& map);

/// True if the bytes begin like a map in any version.
bool is_encoded_map(std::string_view bytes);

/// Reads what encode_map wrote, bit for bit. Throws InputError "name: ..." on anything else. No
/// count is trusted: what is allocated is bounded by a small multiple of bytes.size().
SavedMap decode_map(std::string_view bytes, const std::string& name);

}  // namespace libslam
