#include <libslam/config/rules/rules.hpp>

namespace libslam {

void check_images(const Parameters& p, Conflicts& conflicts) {
  const bool images = p.frontend.source == "stereo_images";
  const StereoFrontendParameters& stereo = p.frontend.stereo;
  if (images && stereo.delivered > stereo.detected) {
    conflicts.push_back({{"frontend.stereo.delivered", "frontend.stereo.detected"},
                         "no more features can be delivered than are sought"});
  }
  if (images && stereo.tracker == "klt" && stereo.detector != "orb") {
    conflicts.push_back({{"frontend.stereo.detector", "frontend.stereo.tracker"},
                         "klt follows corners and describes them by orb"});
  }
  if (!(stereo.max_distance > 0.0) || !(stereo.distance_ratio > 0.0)) {
    conflicts.push_back({{"frontend.stereo.max_distance", "frontend.stereo.distance_ratio"},
                         "at 0 no two descriptors ever belong to one point"});
  }
  if (p.association.method == "appearance" && !images) {
    conflicts.push_back({{"association.method", "frontend.source"},
                         "only points of stereo_images have an appearance"});
  }
  if (p.frontend.source == "fiducials" && p.association.method != "known") {
    conflicts.push_back(
        {{"association.method", "frontend.source"}, "tags say who they are; take known"});
  }
}

}  // namespace libslam
