#pragma once
// Ground truth as text, in the forms that truth_reader.hpp reads.

#include <string>
#include <vector>

#include <libslam/data/ground_truth.hpp>

namespace libslam {

/// `id,x,y`, with `,z` where landmarks have a height; numbers read back bit for bit.
std::string landmarks_text(const std::vector<TrueLandmark>& landmarks);

}  // namespace libslam
