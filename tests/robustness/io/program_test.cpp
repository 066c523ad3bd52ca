// Command lines, imports of malformed files, interrupts.

#include <chrono>
#include <signal.h>
#include <thread>
#include <unistd.h>

#include "program_run.hpp"

namespace libslam {
namespace {

using namespace libslam::test;

using Program = ProgramTest;

TEST_F(Program, CommandLines) {
  for (const std::string& arguments :
       {std::string(""), "--no-such-option " + kGoodLog, "--speed -1 " + kGoodLog,
        "--input-policy lenient " + kGoodLog})
    EXPECT_EQ(run(kPlay + " " + arguments).code, 2) << arguments;
  EXPECT_EQ(run(kPlay + " --help").code, 0);
  EXPECT_EQ(run(kPlay + " --version").code, 0);
  EXPECT_NE(run(kImport + " --help").out.find("Example"), std::string::npos);
  for (const std::string& arguments :
       {std::string(""), std::string("no-such-data-set"), "csv . --out " + path("a.txt"),
        "mrclam . --robot 9 --out " + path("a.rawlog"), "csv --out " + path("a.rawlog")})
    EXPECT_EQ(run(kImport + " " + arguments).code, 2) << arguments;
}

TEST_F(Program, ImportOfMissingAndMalformedFiles) {
  const std::string out = " --out " + path("a.rawlog");
  expect_rejected(run(kImport + " mrclam " + path("nowhere") + " --robot 1" + out),
                  "is not a directory");
  expect_rejected(run(kImport + " csv " + directory_.path().string() + out),
                  "odometry.csv: no such file");
  write("odometry.csv", "t,v,omega\n0,0,0\n1,nan,0\n");
  write("landmarks.csv", "t,id,range,bearing\n0,1,2,0.1\n");
  expect_rejected(run(kImport + " csv " + directory_.path().string() + out), "odometry.csv:3: ");
  write("odometry.csv", "t,v,omega\n0,0,0\n1,1,0\n");
  EXPECT_EQ(run(kImport + " csv " + directory_.path().string() + out).code, 0);
  EXPECT_EQ(run(kPlay + " " + path("a.rawlog")).code, 0);
  const Outcome wheel =
      run(kImport + " csv " + directory_.path().string() + out + " --distort speed=1.1");
  EXPECT_EQ(wheel.code, 2);
  EXPECT_NE(wheel.err.find("'speed' is not one of left, right"), std::string::npos) << wheel.err;
  const Outcome unwritable =
      run(kImport + " csv " + directory_.path().string() + " --out /no/such/place/a.rawlog");
  EXPECT_EQ(unwritable.code, 2);
  EXPECT_NE(unwritable.err.find("cannot be written"), std::string::npos) << unwritable.err;
}

TEST_F(Program, StockRawlogEditReadsTheImportedLog) {
  if (run("command -v rawlog-edit").code != 0) GTEST_SKIP() << "rawlog-edit is not installed";
  write("odometry.csv", "t,v,omega\n10,0,0\n11,1,0\n12,1,0.1\n");
  write("landmarks.csv", "t,id,range,bearing\n10.5,1,2,0.1\n11.5,1,2,0.1\n");
  ASSERT_EQ(run(kImport + " csv " + directory_.path().string() + " --out " + path("a.rawlog")).code,
            0);
  const Outcome info = run("rawlog-edit --info -i " + path("a.rawlog"));
  EXPECT_EQ(info.code, 0);
  EXPECT_NE(info.out.find("Overall number of objects         : 5"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("landmarks, odometry"), std::string::npos) << info.out;
}

TEST_F(Program, InterruptEndsWithTheSummarySoFar) {
  const std::string file = odometry_log(20, [](int, auto&) {});
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (freopen(path("out").c_str(), "w", stdout) == nullptr) _exit(99);
    execl(kPlay.c_str(), kPlay.c_str(), "--speed", "1", file.c_str(), nullptr);
    _exit(98);
  }
  std::this_thread::sleep_for(std::chrono::seconds(2));
  kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_NE(read_all(path("out")).find("flavour"), std::string::npos);
}

}  // namespace
}  // namespace libslam
