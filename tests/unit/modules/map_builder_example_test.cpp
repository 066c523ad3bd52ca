// The example program with both of its builders.

#include <filesystem>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <mrpt/maps/CSimpleMap.h>

#include "support/program_run.hpp"

namespace libslam {
namespace {

struct Result {
  double x = 0.0, y = 0.0, phi = 0.0;
  std::size_t key_frames = 0;
};

/// The line of numbers; the builders log to the same stream.
bool find_result(const std::string& out, Result& result) {
  std::istringstream lines(out);
  std::string line;
  while (std::getline(lines, line)) {
    std::istringstream text(line);
    if (text >> result.x >> result.y >> result.phi >> result.key_frames) return true;
  }
  return false;
}

class MapBuilderExample : public test::ProgramTest {
 protected:
  Result build(const std::string& builder, const std::string& log, const std::string& ini,
               const std::string& picture = "") {
    const std::string map = path(builder + ".simplemap");
    const test::Outcome outcome = run(std::string(LIBSLAM_EXAMPLE_MAP_BUILDER " ") + builder +
                                      " '" + log + "' " + ini + " " + map + " " + picture);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    Result result;
    EXPECT_TRUE(find_result(outcome.out, result)) << outcome.out;
    mrpt::maps::CSimpleMap written;
    EXPECT_TRUE(written.loadFromFile(map));
    EXPECT_EQ(written.size(), result.key_frames);
    EXPECT_TRUE(picture.empty() || std::filesystem::exists(picture));
    return result;
  }
};

TEST_F(MapBuilderExample, RunsLibslam) {
  const std::string ini = write("slam.ini",
                                "[MappingApplication]\n"
                                "[libslam.measurement]\nnoise = configured\nsigma_range = 0.03\n"
                                "sigma_bearing_deg = 0.1\n");
  EXPECT_GT(build("libslam", test::kGoodLog, ini, path("map.png")).key_frames, 10U);
}

// Without a picture: MRPT's own drawing throws inside OpenCV on this map.
TEST_F(MapBuilderExample, RunsMrptsBuilder) {
  const std::string ini =
      write("icp.ini",
            "[MappingApplication]\noccupancyGrid_count = 1\npointsMap_count = 1\n"
            "[MappingApplication_occupancyGrid_00_creationOpts]\nresolution = 0.1\n");
  const std::string log =
      "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
  EXPECT_GT(build("icp", log, ini).key_frames, 1U);
}

TEST_F(MapBuilderExample, RejectsABadCommandLine) {
  EXPECT_EQ(run(std::string(LIBSLAM_EXAMPLE_MAP_BUILDER) + " nobody log ini").code, 2);
  const test::Outcome outcome =
      run(std::string(LIBSLAM_EXAMPLE_MAP_BUILDER) + " libslam /no/such.rawlog /dev/null");
  EXPECT_EQ(outcome.code, 4);
}

}  // namespace
}  // namespace libslam
