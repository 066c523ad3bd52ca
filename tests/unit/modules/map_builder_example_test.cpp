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

class MapBuilderExample : public test::ProgramTest {
 protected:
  Result build(const std::string& builder, const std::string& log, const std::string& ini) {
    const std::string map = path(builder + ".simplemap");
    const test::Outcome outcome =
        run(std::string(LIBSLAM_EXAMPLE_MAP_BUILDER " ") + builder + " '" + log + "' " + ini + " " +
            map + " " + path(builder + ".png"));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    Result result;
    // MRPT's builder logs to stdout as well; the result is the last line.
    std::istringstream lines(outcome.out);
    std::string line, last;
    while (std::getline(lines, line)) last = line;
    std::istringstream text(last);
    EXPECT_TRUE(text >> result.x >> result.y >> result.phi >> result.key_frames) << outcome.out;
    mrpt::maps::CSimpleMap written;
    EXPECT_TRUE(written.loadFromFile(map));
    EXPECT_EQ(written.size(), result.key_frames);
    EXPECT_TRUE(std::filesystem::exists(path(builder + ".png")));
    return result;
  }
};

TEST_F(MapBuilderExample, RunsLibslam) {
  const std::string ini = write("slam.ini",
                                "[MappingApplication]\n"
                                "[libslam.measurement]\nnoise = configured\nsigma_range = 0.03\n"
                                "sigma_bearing_deg = 0.1\n");
  EXPECT_GT(build("libslam", test::kGoodLog, ini).key_frames, 10U);
}

TEST_F(MapBuilderExample, RunsMrptsBuilder) {
  const std::string ini =
      write("icp.ini",
            "[MappingApplication]\noccupancyGrid_count = 1\npointsMap_count = 1\n"
            "[MappingApplication_occupancyGrid_00_creationOpts]\nresolution = 0.1\n");
  const std::string log = "/usr/share/mrpt/datasets/localization_demo.rawlog";
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
