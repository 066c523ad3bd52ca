// Uses the installed library the way an outside program does: a state with one pose, printed back.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <libslam/state/gaussian_state.hpp>

int main(int argc, char** argv) {
  libslam::GaussianState state;
  const Eigen::Vector3d pose(1.0, 2.0, 3.0);
  const Eigen::Matrix3d cov = Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal();
  const libslam::BlockId robot = state.add({"robot", libslam::Chart::kSE2}, pose, cov);

  const bool state_kept = state.estimate(robot) == pose && state.covariance_of(robot) == cov;
  const bool wrapped = std::abs(libslam::wrap_angle(7.0) - (7.0 - 2.0 * std::acos(-1.0))) < 1e-12;
  // A prefix without the layers would mean that the headers came from the source tree.
  const bool installed =
      argc == 2 && std::filesystem::exists(std::filesystem::path(argv[1]) / "include/libslam/state");
  std::printf("state %d, angle %d, headers %d\n", state_kept, wrapped, installed);
  return state_kept && wrapped && installed ? 0 : 1;
}
