// Range-bearing SLAM over a rawlog: the same program for MRPT's filter and for libslam's.
//
// usage:   kf_slam_2d RAWLOG [INI [MATLAB_FILE]]
// example: kf_slam_2d /usr/share/mrpt/datasets/kf-slam_demo.rawlog
//              /usr/share/mrpt/config_files/kf-slam/EKF-SLAM_test_2d.ini map.m
//
// INI is a file of MRPT's kf-slam; for libslam it may have sections [libslam.*] as well.
// Prints "x y phi landmarks" at the end, in m and rad.

#include <cstdint>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <vector>

#include <Eigen/Dense>  // before MRPT's matrices
#include <mrpt/config/CConfigFile.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

// The switch: everything below is the same for both.
#ifdef WITH_MRPT_FILTER
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>
using Slam = mrpt::slam::CRangeBearingKFSLAM2D;
#else
#include <libslam/modules/range_bearing_slam_2d.hpp>
using Slam = libslam::RangeBearingSlam2D;
#endif

namespace {

/// Feeds the log, object by object. A frame without an action before it, such as the first one of
/// many logs, comes with an empty collection.
void play(const char* rawlog, Slam& slam) {
  mrpt::io::CFileGZInputStream file(rawlog);
  auto archive = mrpt::serialization::archiveFrom(file);
  auto action = mrpt::obs::CActionCollection::Create();
  try {
    while (const auto object = archive.ReadObject()) {
      if (auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
        slam.processActionObservation(action, frame);
        action = mrpt::obs::CActionCollection::Create();
      } else if (auto read = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object)) {
        action = read;
      }
    }
  } catch (const mrpt::serialization::CExceptionEOF&) {
    // The log ends here.
  }
}

void print_result(const Slam& slam) {
  mrpt::poses::CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> landmarks;
  std::map<unsigned int, std::int64_t> ids;
  mrpt::math::CVectorDouble state;
  mrpt::math::CMatrixDouble cov;
  slam.getCurrentState(pose, landmarks, ids, state, cov);
  std::printf("%.9f %.9f %.9f %zu\n", pose.mean.x(), pose.mean.y(), pose.mean.phi(),
              landmarks.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    std::fprintf(stderr, "usage: kf_slam_2d RAWLOG [INI [MATLAB_FILE]]\n");
    return 2;
  }
  try {
    Slam slam;
    if (argc > 2) slam.loadOptions(mrpt::config::CConfigFile(argv[2]));
    play(argv[1], slam);
    print_result(slam);
    if (argc > 3) slam.saveMapAndPath2DRepresentationAsMATLABFile(argv[3]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kf_slam_2d: %s\n", error.what());
    return 4;
  }
}
