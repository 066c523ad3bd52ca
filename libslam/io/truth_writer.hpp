#pragma once
// Ground truth in the forms, and under the names, that truth_reader.hpp reads.

#include <string>
#include <vector>

#include <libslam/data/ground_truth.hpp>

namespace libslam {

/// `id,x,y`, with `,z` where landmarks have a height; numbers read back bit for bit.
std::string landmarks_text(const std::vector<TrueLandmark>& landmarks);

/// `t1 t2 x y z roll pitch yaw`; numbers read back bit for bit.
std::string relations_text(const std::vector<PoseRelation>& relations);

/// Removes X.truth.tum, X.landmarks.csv and X.relations of an earlier import beside `rawlog`
/// (X.rawlog).
void remove_truth_beside(const std::string& rawlog);

/// Writes X.truth.json with `notes` beside `rawlog` (X.rawlog) and, where known, X.truth.tum,
/// X.landmarks.csv and X.relations. Throws std::runtime_error if a file cannot be written.
void write_truth_beside(const std::string& rawlog, const GroundTruth& truth,
                        const std::string& notes);

}  // namespace libslam
