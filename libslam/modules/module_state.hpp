#pragma once
// What a module needs to go on where it was, in an archive of MRPT.
//
// In the archive: "SLAMSTATE" and a version, the number of bytes that follow, then steps, clock and
// the map as io/map_encoding.hpp has it, and a SHA-256 of them all.

#include <cstdint>

#include <libslam/io/pair_assembler.hpp>
#include <libslam/map/saved_map.hpp>

namespace mrpt::serialization {
class CArchive;
}

namespace libslam {

struct ModuleState {
  SavedMap map;            ///< pose, calibration, landmarks and their joint covariance
  std::int64_t steps = 0;  ///< so far
  PairAssembler::Clock clock;
};

/// Throws std::invalid_argument if the map is not sound (check_saved_map), and what the archive
/// throws.
void write_state(mrpt::serialization::CArchive& out, const ModuleState& state);

/// Throws InputError "saved state: ..." on anything that write_state did not write, or that ends
/// early. What is allocated is bounded by a small multiple of what the archive has.
ModuleState read_state(mrpt::serialization::CArchive& in);

}  // namespace libslam
