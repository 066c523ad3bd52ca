// MRPT's packaged kf-slam_demo: simulated, 70 landmarks, sensor sigma 1 cm and 0.1 degrees.

#include <tests/golden/log_run.hpp>

using namespace libslam;
using namespace libslam::test;

namespace {
const char* const kLog = "/usr/share/mrpt/datasets/kf-slam_demo.rawlog";
}

TEST(KfSlamDemo, KnownIdentities) {
  const TemporaryDirectory scratch;
  const LogRun run = run_log("range_bearing.yaml", kLog, scratch.path() / "run");
  EXPECT_EQ(run.map.size(), 70u);
  EXPECT_LE(run.summary.truth->path->raw->rmse_m, 0.005);
  EXPECT_LE(*run.summary.truth->map->rmse_aligned_m, 0.003);
}

// MRPT makes 84 to 100 landmarks of the 70. Whatever the gates between one and five nines.
TEST(KfSlamDemo, WithoutIdentitiesTheMapHasNoDuplicates) {
  const TemporaryDirectory scratch;
  for (const char* gate : {"0.99", "0.999", "0.9999", "0.99999"}) {
    const LogRun run = run_log("range_bearing_unknown_ids.yaml", kLog, scratch.path() / "run",
                               {std::string("association.gate_probability=") + gate});
    EXPECT_EQ(run.map.size(), 70u) << gate;
    EXPECT_LE(run.summary.truth->path->raw->rmse_m, 0.006) << gate;
    EXPECT_EQ(run.summary.truth->map->duplicates, 0) << gate;
    EXPECT_EQ(run.summary.truth->map->missed, 0) << gate;
  }
}

TEST(KfSlamDemo, SameBytesTwice) {
  const TemporaryDirectory scratch;
  const auto text_of = [&](const char* directory, const char* name) {
    std::ifstream in(scratch.path() / directory / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  run_log("range_bearing_unknown_ids.yaml", kLog, scratch.path() / "a");
  run_log("range_bearing_unknown_ids.yaml", kLog, scratch.path() / "b");
  for (const char* name : {"trajectory.csv", "trajectory.tum", "map.csv", "config.yaml"}) {
    EXPECT_EQ(text_of("a", name), text_of("b", name)) << name;
    EXPECT_GT(text_of("a", name).size(), 100u) << name;
  }
}
