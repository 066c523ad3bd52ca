#pragma once
// A picture of the matches of one stereo pair.

#include <cstdint>
#include <vector>

#include <mrpt/obs/CObservationStereoImages.h>

#include <libslam/frontend/frontend.hpp>

namespace libslam {

/// PNG of the rectified left image above the right one, with every feature as a dot in both and a
/// stroke as long as its disparity in the left; near points are red, far ones blue. `features`:
/// what a front-end made of this observation. Empty where the observation has no usable images.
std::vector<std::uint8_t> draw_matches(const mrpt::obs::CObservationStereoImages& observation,
                                       const FeatureBatch& features);

}  // namespace libslam
