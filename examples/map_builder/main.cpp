// A program of MRPT for any map builder, and libslam as one of them.
//
// usage:   map_builder icp|libslam RAWLOG INI [MAP.simplemap [PICTURE.png]]
// example: map_builder libslam /usr/share/mrpt/datasets/kf-slam_demo.rawlog
//              config/mrpt_adaptive.ini map.simplemap map.png
//
// INI is a file of MRPT's icp-slam; for libslam it may have sections [libslam.*], [calibration],
// [adaptation] and [disturbance] as well.
// Prints "x y phi key_frames" at the end, in m and rad.

#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include <mrpt/config/CConfigFile.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/slam/CMetricMapBuilderICP.h>

#include <libslam/modules/slam_map_builder.hpp>

namespace {

using mrpt::slam::CMetricMapBuilder;

// The only place that knows which builder it is.
std::unique_ptr<CMetricMapBuilder> make_builder(const std::string& name,
                                                const mrpt::config::CConfigFile& ini) {
  const std::string section = "MappingApplication";
  if (name == "icp") {
    auto icp = std::make_unique<mrpt::slam::CMetricMapBuilderICP>();
    icp->ICP_options.loadFromConfigFile(ini, section);
    icp->ICP_params.loadFromConfigFile(ini, "ICP");
    return icp;
  }
  auto slam = std::make_unique<libslam::SlamMapBuilder>();
  slam->loadOptions(ini, section);
  return slam;
}

/// Feeds the log, object by object. A frame without an action before it, such as the first one of
/// many logs, comes with an empty collection.
void play(const char* rawlog, CMetricMapBuilder& builder) {
  mrpt::io::CFileGZInputStream file(rawlog);
  auto archive = mrpt::serialization::archiveFrom(file);
  auto action = mrpt::obs::CActionCollection::Create();
  try {
    while (const auto object = archive.ReadObject()) {
      if (auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
        builder.processActionObservation(*action, *frame);
        action = mrpt::obs::CActionCollection::Create();
      } else if (auto read = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object)) {
        action = read;
      }
    }
  } catch (const mrpt::serialization::CExceptionEOF&) {
    // The log ends here.
  }
}

void print_result(CMetricMapBuilder& builder) {
  const mrpt::poses::CPose3D pose = builder.getCurrentPoseEstimation()->getMeanVal();
  std::printf("%.9f %.9f %.9f %u\n", pose.x(), pose.y(), pose.yaw(),
              builder.getCurrentlyBuiltMapSize());
}

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  if (argc < 4 || argc > 6 || (name != "icp" && name != "libslam")) {
    std::fprintf(stderr,
                 "usage: map_builder icp|libslam RAWLOG INI [MAP.simplemap [PICTURE.png]]\n");
    return 2;
  }
  try {
    const auto builder = make_builder(name, mrpt::config::CConfigFile(argv[3]));
    builder->initialize();
    play(argv[2], *builder);
    print_result(*builder);
    if (argc > 4) builder->saveCurrentMapToFile(argv[4]);
    if (argc > 5) builder->saveCurrentEstimationToImage(argv[5]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "map_builder: %s\n", error.what());
    return 4;
  }
}
