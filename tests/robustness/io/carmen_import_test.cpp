// slam-import carmen and brenner as a user meets them: damaged, hostile and missing files.

#include <filesystem>

#include "program_run.hpp"

namespace libslam {
namespace {

using namespace libslam::test;

class CarmenImport : public ProgramTest {
 protected:
  Outcome import_log(const std::string& log, const std::string& options = "") const {
    return run(std::string(LIBSLAM_SLAM_IMPORT) + " carmen " + log + " --out " + path("a.rawlog") +
               " " + options);
  }
  static std::string flaser(double time) {
    std::string line = "FLASER 180";
    for (int i = 0; i < 180; ++i) line += " 2.50";
    return line + " 0 0 0 0 0 0 " + std::to_string(time) + " host 0\n";
  }
};

TEST_F(CarmenImport, GoodLogGivesARawlogThatPlays) {
  const Outcome done = import_log(write("x.clf", flaser(1.0) + flaser(2.0)));
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("2 scans"), std::string::npos) << done.out;
  EXPECT_EQ(run(std::string(LIBSLAM_SLAM_PLAY) + " " + path("a.rawlog")).code, 0);
  EXPECT_EQ(import_log(path("x.clf"), "--max-range 0").code, 2);
  EXPECT_EQ(import_log(path("x.clf"), "--odometry wheels").code, 2);
}

TEST_F(CarmenImport, OneLineNamesFileAndPlaceAndNothingIsLeftBehind) {
  expect_rejected(import_log(path("none.clf")), "none.clf: no such file");
  expect_rejected(import_log(directory_.path().string()), "is a directory");
  expect_rejected(import_log(write("empty.clf", "")), "the file is empty");
  expect_rejected(import_log(write("text.clf", "hello\nworld\n")), "holds no scans");
  expect_rejected(import_log(write("odom.clf", "ODOM 0 0 0 0 0 0 1 h 1\n"), "--odometry messages"),
                  "holds no scans");
  expect_rejected(import_log(write("nan.clf", flaser(1.0) + "FLASER 180 nan\n")), "nan.clf:2: ");
  expect_rejected(import_log(write("cut.clf", flaser(1.0).substr(0, 300))), "cut.clf:1: ");
  expect_rejected(import_log(write("set.clf", flaser(100.0) + flaser(1.0))), "set.clf:2: ");
  expect_rejected(import_log(write("bytes.clf", std::string(100000, '\xff'))), "bytes.clf:1: ");
  expect_rejected(import_log(write("huge.clf", "FLASER 4294967297 1 2 3\n")), "huge.clf:1: ");
  EXPECT_FALSE(std::filesystem::exists(path("a.rawlog")));
  EXPECT_FALSE(std::filesystem::exists(path("a.truth.json")));
}

TEST_F(CarmenImport, RelationsAndReferenceAreChecked) {
  const std::string log = write("x.clf", flaser(1.0) + flaser(2.0));
  expect_rejected(import_log(log, "--relations " + write("few.relations", "1 2 3\n")),
                  "few.relations:1: ");
  expect_rejected(import_log(log, "--relations " + write("up.relations", "1 2 0 0 1 0 0 0\n")),
                  "leaves the plane");
  expect_rejected(import_log(log, "--reference " + path("none.log")), "no such file");
  expect_rejected(import_log(log, "--reference " + write("none.log", "# empty\n")),
                  "holds no scans");
  write("x.relations", "1 2 0.5 0 0 0 0 0\n");
  EXPECT_EQ(import_log(log).code, 0);
  EXPECT_TRUE(std::filesystem::exists(path("a.relations")));
}

// A gigabyte of one line, and a compressed bomb of zeros: memory stays where it is.
TEST_F(CarmenImport, MemoryIsBounded) {
  if (run("command -v gzip").code != 0) GTEST_SKIP() << "gzip is not installed";
  ASSERT_EQ(run("head -c 300000000 /dev/zero | gzip -1 > " + path("bomb.clf.gz") + " && ls").code,
            0);
  const Outcome bomb = run("bash -c 'ulimit -v 2000000; " + std::string(LIBSLAM_SLAM_IMPORT) +
                           " carmen " + path("bomb.clf.gz") + " --out " + path("a.rawlog") + "'");
  expect_rejected(bomb, "bomb.clf.gz:1: line longer than");
}

TEST_F(CarmenImport, BrennerNeedsItsFourFiles) {
  const auto import_brenner = [&] {
    return run(std::string(LIBSLAM_SLAM_IMPORT) + " brenner " + directory_.path().string() +
               " --out " + path("a.rawlog"));
  };
  expect_rejected(import_brenner(), "robot4_motors.txt: no such file");
  write("robot4_motors.txt", "M 1 5 5 0 0 6 6 0\nM 2 99999999999 5 0 0 6 6 0\n");
  expect_rejected(import_brenner(), "robot4_motors.txt:2: encoder counter");
  write("robot4_motors.txt", "M 1 5 5 0 0 6 6 0\nX 2\n");
  expect_rejected(import_brenner(), "robot4_motors.txt:2: a row begins with M");
  write("robot4_motors.txt", "M 1 5 5 0 0 6 6 0\nM 2 6 5 0 0 7 6 0\n");
  write("robot4_scan.txt", "S 1 3 1 2 3\n");
  expect_rejected(import_brenner(), "a scan has 660 ranges");
}

}  // namespace
}  // namespace libslam
