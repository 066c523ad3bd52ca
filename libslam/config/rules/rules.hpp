#pragma once
// The rules of validation, a function per group; each appends what it finds.

#include <vector>

#include <libslam/config/validation.hpp>

namespace libslam {

using Conflicts = std::vector<Conflict>;

void check_input(const Parameters& p, Conflicts& conflicts);
void check_calibration(const Parameters& p, Conflicts& conflicts);
void check_frontend(const Parameters& p, Conflicts& conflicts);
/// Displacements of a sensor take the place of landmarks; the two do not mix.
void check_displacement(const Parameters& p, Conflicts& conflicts);
/// Robots in space, and points in pairs of images.
void check_spatial(const Parameters& p, Conflicts& conflicts);
/// Straight walls, and what is done with them alone.
void check_lines(const Parameters& p, Conflicts& conflicts);
/// Front-ends that look at images.
void check_images(const Parameters& p, Conflicts& conflicts);
void check_association(const Parameters& p, Conflicts& conflicts);
void check_filter(const Parameters& p, TruthAccess truth, Conflicts& conflicts);
void check_map(const Parameters& p, Conflicts& conflicts);
void check_policies(const Parameters& p, Conflicts& conflicts);

}  // namespace libslam
