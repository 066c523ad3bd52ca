// What the programs do with input that is not what it should be: exit code and one clear line.

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/serialization/CArchive.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <support/temporary_directory.hpp>
#include <thread>

namespace libslam {
namespace {

const std::string kPlay = LIBSLAM_SLAM_PLAY, kImport = LIBSLAM_SLAM_IMPORT;
const std::string kGoodLog = "/usr/share/mrpt/datasets/kf-slam_demo.rawlog";

struct Outcome {
  int code = -1;
  std::string out, err;
};

std::string read_all(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class RejectedInput : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  std::string write(const std::string& name, const std::string& bytes) const {
    return directory_.write(name, bytes).string();
  }

  Outcome run(const std::string& command) const {
    const int status =
        std::system((command + " >" + path("out") + " 2>" + path("err") + " </dev/null").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_all(path("out")), read_all(path("err"))};
  }

  /// One line on stderr that holds `text`, nothing on stdout.
  void expect_rejected(const Outcome& outcome, const std::string& text) const {
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  }

  /// Odometry readings at 0, 1, ... s; `mend` may change one of them.
  template <typename Change>
  std::string odometry_log(int count, Change change) const {
    mrpt::io::CFileGZOutputStream out(path("odometry.rawlog"));
    auto archive = mrpt::serialization::archiveFrom(out);
    for (int i = 0; i < count; ++i) {
      mrpt::obs::CObservationOdometry o;
      o.timestamp = mrpt::Clock::fromDouble(1000.0 + i);
      o.odometry = {0.1 * i, 0.0, 0.0};
      change(i, o);
      archive << o;
    }
    return path("odometry.rawlog");
  }

  test::TemporaryDirectory directory_;
};

TEST_F(RejectedInput, MissingFile) {
  expect_rejected(run(kPlay + " " + path("none.rawlog")), "none.rawlog: no such file");
}

TEST_F(RejectedInput, Directory) {
  expect_rejected(run(kPlay + " " + directory_.path().string()), "is a directory");
}

TEST_F(RejectedInput, EmptyFile) {
  expect_rejected(run(kPlay + " " + write("a.rawlog", "")), "a.rawlog: the file is empty");
}

TEST_F(RejectedInput, EmptyCompressedFile) {
  { mrpt::io::CFileGZOutputStream out(path("a.rawlog")); }
  expect_rejected(run(kPlay + " " + path("a.rawlog")), "holds no data");
}

TEST_F(RejectedInput, TextFile) {
  expect_rejected(run(kPlay + " " + write("a.rawlog", "this is not a rawlog\n")), "is not a rawlog");
}

TEST_F(RejectedInput, RandomBytes) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 10; ++trial) {
    std::string bytes(4096, '\0');
    for (char& c : bytes) c = static_cast<char>(random() & 0xFFU);
    const Outcome outcome = run(kPlay + " " + write("a.rawlog", bytes));
    expect_rejected(outcome, "a.rawlog: ");
  }
}

TEST_F(RejectedInput, UnknownClassAtTheStart) {
  expect_rejected(run(kPlay + " " + write("a.rawlog", "\x85" "CCake" "\x01 bytes")),
                  "entry 0: unknown class 'CCake'");
}

TEST_F(RejectedInput, GarbageInsideKeepsWhatCameBefore) {
  std::string bytes;
  {
    const std::string good = odometry_log(10, [](int, auto&) {});
    ASSERT_EQ(run("gzip -dc " + good + " > " + path("plain")).code, 0);
    bytes = read_all(path("out"));
  }
  bytes += std::string("\x85" "CCake" "\x01", 7);
  const std::string file = write("a.rawlog", bytes);
  const Outcome outcome = run(kPlay + " --json " + file);
  EXPECT_EQ(outcome.code, 5) << outcome.err;
  EXPECT_NE(outcome.out.find("\"entries\": 10"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("entry 10: unknown class 'CCake'"), std::string::npos) << outcome.err;
  expect_rejected(run(kPlay + " --input-policy strict " + file), "entry 10: unknown class");
}

TEST_F(RejectedInput, TruncatedLogKeepsWhatCameBefore) {
  const std::string good = read_all(kGoodLog);
  for (const double part : {0.1, 0.5, 0.99}) {
    const auto length = static_cast<std::size_t>(part * static_cast<double>(good.size()));
    const std::string file = write("a.rawlog", good.substr(0, length));
    const Outcome outcome = run(kPlay + " " + file);
    EXPECT_EQ(outcome.code, 5) << outcome.err;
    EXPECT_NE(outcome.err.find("the log ends here"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.out.find("CSensoryFrame"), std::string::npos);
    expect_rejected(run(kPlay + " --input-policy strict " + file), "a.rawlog: entry ");
  }
}

TEST_F(RejectedInput, CorruptBytesNeverCrash) {
  const std::string good = read_all(kGoodLog);
  std::mt19937 random(2);
  for (int trial = 0; trial < 15; ++trial) {
    std::string bytes = good;
    for (int i = 0; i < 10; ++i) bytes[random() % bytes.size()] = static_cast<char>(random() & 0xFFU);
    const Outcome outcome = run(kPlay + " " + write("a.rawlog", bytes));
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 4 || outcome.code == 5)
        << outcome.code << " " << outcome.err;
  }
}

TEST_F(RejectedInput, CorruptBytesInAnUncompressedLogNeverCrash) {
  ASSERT_EQ(run("gzip -dc " + kGoodLog).code, 0);
  const std::string good = read_all(path("out"));
  std::mt19937 random(3);
  for (int trial = 0; trial < 30; ++trial) {
    std::string bytes = good;
    for (int i = 0; i < 5; ++i) bytes[random() % bytes.size()] = static_cast<char>(random() & 0xFFU);
    const Outcome outcome = run(kPlay + " " + write("a.rawlog", bytes));
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 4 || outcome.code == 5)
        << outcome.code << " " << outcome.err;
  }
}

TEST_F(RejectedInput, EntryThatClaimsGigabytes) {
  {
    mrpt::io::CFileGZOutputStream out(path("comment.rawlog"));
    mrpt::obs::CObservationComment comment;
    comment.text = "MARK";
    mrpt::serialization::archiveFrom(out) << comment;
  }
  ASSERT_EQ(run("gzip -dc " + path("comment.rawlog")).code, 0);
  std::string bytes = read_all(path("out"));
  const auto mark = bytes.find("MARK");
  ASSERT_NE(mark, std::string::npos);
  bytes.replace(mark - 4, 4, "\xF0\xFF\xFF\xFF");  // length of the text: 4 GiB
  expect_rejected(run(kPlay + " " + write("a.rawlog", bytes)), "entry 0: this entry asks for more than");
  rusage used{};
  ASSERT_EQ(getrusage(RUSAGE_CHILDREN, &used), 0);
  // [KiB]: the 512 MiB that the guard grants to one entry, and the program itself.
  EXPECT_LT(used.ru_maxrss, 700 * 1024);
}

TEST_F(RejectedInput, GzipBombEndsTheLog) {
  {
    mrpt::io::CFileGZOutputStream out(path("bomb.rawlog"), mrpt::io::OpenMode::TRUNCATE, 9);
    mrpt::obs::CObservationComment comment;
    comment.text.assign(40U << 20, 'A');
    auto archive = mrpt::serialization::archiveFrom(out);
    for (int i = 0; i < 5; ++i) archive << comment;  // 200 MiB from 200 KiB
  }
  const Outcome outcome = run(kPlay + " " + path("bomb.rawlog"));
  EXPECT_EQ(outcome.code, 5);
  EXPECT_NE(outcome.err.find("entry 1: the compressed file expands more than 200 times"),
            std::string::npos)
      << outcome.err;
  expect_rejected(run(kPlay + " --input-policy strict " + path("bomb.rawlog")), "expands more than");
}

TEST_F(RejectedInput, NonFiniteOdometry) {
  const std::string file = odometry_log(10, [](int i, auto& o) {
    if (i == 4) o.odometry.x(std::numeric_limits<double>::quiet_NaN());
  });
  const Outcome outcome = run(kPlay + " " + file);
  EXPECT_EQ(outcome.code, 5);
  EXPECT_NE(outcome.err.find("entry 4: odometry is not finite"), std::string::npos) << outcome.err;
  expect_rejected(run(kPlay + " --input-policy strict " + file), "entry 4: odometry is not finite");
}

TEST_F(RejectedInput, TimeGoingBackwards) {
  const std::string file = odometry_log(10, [](int i, auto& o) {
    if (i == 6) o.timestamp = mrpt::Clock::fromDouble(10.0);
  });
  EXPECT_EQ(run(kPlay + " " + file).code, 5);
  EXPECT_EQ(run(kPlay + " --input-policy repair " + file).code, 0);
  expect_rejected(run(kPlay + " --input-policy strict " + file), "entry 6: odometry goes back in time");
}

TEST_F(RejectedInput, CommandLines) {
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

TEST_F(RejectedInput, ImportOfMissingAndMalformedFiles) {
  const std::string out = " --out " + path("a.rawlog");
  expect_rejected(run(kImport + " mrclam " + path("nowhere") + " --robot 1" + out), "is not a directory");
  expect_rejected(run(kImport + " csv " + directory_.path().string() + out), "odometry.csv: no such file");
  write("odometry.csv", "t,v,omega\n0,0,0\n1,nan,0\n");
  write("landmarks.csv", "t,id,range,bearing\n0,1,2,0.1\n");
  expect_rejected(run(kImport + " csv " + directory_.path().string() + out), "odometry.csv:3: ");
  write("odometry.csv", "t,v,omega\n0,0,0\n1,1,0\n");
  EXPECT_EQ(run(kImport + " csv " + directory_.path().string() + out).code, 0);
  EXPECT_EQ(run(kPlay + " " + path("a.rawlog")).code, 0);
  const Outcome wheel = run(kImport + " csv " + directory_.path().string() + out + " --distort speed=1.1");
  EXPECT_EQ(wheel.code, 2);
  EXPECT_NE(wheel.err.find("'speed' is not one of left, right"), std::string::npos) << wheel.err;
  const Outcome unwritable =
      run(kImport + " csv " + directory_.path().string() + " --out /no/such/place/a.rawlog");
  EXPECT_EQ(unwritable.code, 2);
  EXPECT_NE(unwritable.err.find("cannot be written"), std::string::npos) << unwritable.err;
}

TEST_F(RejectedInput, StockRawlogEditReadsTheImportedLog) {
  if (run("command -v rawlog-edit").code != 0) GTEST_SKIP() << "rawlog-edit is not installed";
  write("odometry.csv", "t,v,omega\n10,0,0\n11,1,0\n12,1,0.1\n");
  write("landmarks.csv", "t,id,range,bearing\n10.5,1,2,0.1\n11.5,1,2,0.1\n");
  ASSERT_EQ(run(kImport + " csv " + directory_.path().string() + " --out " + path("a.rawlog")).code, 0);
  const Outcome info = run("rawlog-edit --info -i " + path("a.rawlog"));
  EXPECT_EQ(info.code, 0);
  EXPECT_NE(info.out.find("Overall number of objects         : 5"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("landmarks, odometry"), std::string::npos) << info.out;
}

TEST_F(RejectedInput, InterruptEndsWithTheSummarySoFar) {
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
