#include <libslam/pipeline/landmark_identity.hpp>

namespace libslam {

LandmarkIdentity landmark_identity(const Parameters& parameters) {
  const bool known =
      parameters.association.uses_identities() && parameters.frontend.source != "stereo_images";
  return known ? LandmarkIdentity::known : LandmarkIdentity::unknown;
}

}  // namespace libslam
