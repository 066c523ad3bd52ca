#pragma once
// The building as a picture: walls over the occupancy grid, with the path and a scale.

#include <cstdint>
#include <vector>

#include <mrpt/maps/CSimpleMap.h>

#include <libslam/map/landmark_map.hpp>

namespace mrpt::maps {
class COccupancyGridMap2D;
}

namespace libslam {

/// A PNG file, north up: the cells of `grid` in light tones, cut to what was seen, the key poses of
/// `map` as a line with a ring at its start and a dot at its end, the lines of `landmarks` as thin
/// dark segments and their points as dots; around them axes in metres and a scale bar. The drawing
/// without its margins is at most `max_side` pixels wide and high. Empty where it cannot be
/// encoded.
std::vector<std::uint8_t> draw_map(const mrpt::maps::COccupancyGridMap2D& grid,
                                   const mrpt::maps::CSimpleMap& map, const LandmarkMap& landmarks,
                                   int max_side = 1600);

}  // namespace libslam
