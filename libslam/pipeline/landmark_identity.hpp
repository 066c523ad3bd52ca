#pragma once
// How the landmarks of a run are held against the true ones.

#include <libslam/config/parameters.hpp>
#include <libslam/result/metrics.hpp>

namespace libslam {

/// known where the map carries the identities of the log: its association uses them, and they are
/// not numbers that a front-end gives to points of images as they come.
LandmarkIdentity landmark_identity(const Parameters& parameters);

}  // namespace libslam
