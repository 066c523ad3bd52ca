#pragma once
// Landmark maps inside mrpt::maps::CSimpleMap, the one form of a map that every map builder of MRPT
// reads and writes.

#include <optional>

#include <mrpt/maps/CSimpleMap.h>

#include <libslam/config/parameters.hpp>
#include <libslam/map/saved_map.hpp>

namespace libslam {

/// Adds `map` (io/map_encoding.hpp, in base64) as a CObservationComment to the last frame of
/// `key_frames`, which must not be empty. MRPT's own maps and tools pass over it.
void attach_map(const SavedMap& map, mrpt::maps::CSimpleMap& key_frames);

/// The map that attach_map added last, if there is one. Throws InputError if it is damaged.
std::optional<SavedMap> attached_map(const mrpt::maps::CSimpleMap& key_frames);

/// The frame without what attach_map added.
mrpt::obs::CSensoryFrame::Ptr without_map(const mrpt::obs::CSensoryFrame::Ptr& frame);

/// The landmarks that the frames show, to the front-end and association of `parameters`, from mean
/// poses that count as exact, the way MRPT makes metric maps of them. For planar filters.
SavedMap map_of_frames(const mrpt::maps::CSimpleMap& key_frames, Parameters parameters);

}  // namespace libslam
