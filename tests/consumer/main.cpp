// Uses the installed library the way an outside program does: a rawlog in, path and map out.
// usage: consumer RAWLOG RUN_DIRECTORY; succeeds if the 70 landmarks of kf-slam_demo are in the
// map.

#include <cstdio>
#include <exception>

#include <libslam/pipeline/run.hpp>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: consumer RAWLOG RUN_DIRECTORY\n");
    return 2;
  }
  try {
    libslam::RunRequest request;
    request.rawlog = argv[1];
    request.directory = argv[2];
    request.force = true;
    const libslam::RunSummary summary = libslam::run_rawlog(request);
    std::printf("%s, %lld landmarks\n", summary.status.c_str(),
                static_cast<long long>(summary.result.landmarks));
    return summary.exit_code == 0 && summary.result.landmarks == 70 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "consumer: %s\n", error.what());
    return 1;
  }
}
