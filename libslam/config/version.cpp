#include <libslam/config/version.hpp>

namespace libslam {

std::string_view version() {
  return LIBSLAM_VERSION;
}

std::string_view git_revision() {
  return LIBSLAM_GIT_REVISION;
}

}  // namespace libslam
