// Rawlogs that are not what they should be: exit code and one clear line.

#include <limits>
#include <random>
#include <sys/resource.h>

#include <mrpt/obs/CObservationComment.h>

#include <libslam/io/memory_budget.hpp>

#include "program_run.hpp"

namespace libslam {
namespace {

using namespace libslam::test;

using RejectedRawlog = ProgramTest;

TEST_F(RejectedRawlog, MissingFile) {
  expect_rejected(run(kPlay + " " + path("none.rawlog")), "none.rawlog: no such file");
}

TEST_F(RejectedRawlog, Directory) {
  expect_rejected(run(kPlay + " " + directory_.path().string()), "is a directory");
}

TEST_F(RejectedRawlog, EmptyFile) {
  expect_rejected(run(kPlay + " " + write("a.rawlog", "")), "a.rawlog: the file is empty");
}

TEST_F(RejectedRawlog, EmptyCompressedFile) {
  { mrpt::io::CFileGZOutputStream out(path("a.rawlog")); }
  expect_rejected(run(kPlay + " " + path("a.rawlog")), "holds no data");
}

TEST_F(RejectedRawlog, TextFile) {
  expect_rejected(run(kPlay + " " + write("a.rawlog", "this is not a rawlog\n")),
                  "is not a rawlog");
}

TEST_F(RejectedRawlog, RandomBytes) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 10; ++trial) {
    std::string bytes(4096, '\0');
    for (char& c : bytes) c = static_cast<char>(random() & 0xFFU);
    const Outcome outcome = run(kPlay + " " + write("a.rawlog", bytes));
    expect_rejected(outcome, "a.rawlog: ");
  }
}

TEST_F(RejectedRawlog, UnknownClassAtTheStart) {
  expect_rejected(run(kPlay + " " +
                      write("a.rawlog",
                            "\x85"
                            "CCake"
                            "\x01 bytes")),
                  "entry 0: unknown class 'CCake'");
}

TEST_F(RejectedRawlog, GarbageInsideKeepsWhatCameBefore) {
  std::string bytes;
  {
    const std::string good = odometry_log(10, [](int, auto&) {});
    ASSERT_EQ(run("gzip -dc " + good + " > " + path("plain")).code, 0);
    bytes = read_all(path("out"));
  }
  bytes += std::string(
      "\x85"
      "CCake"
      "\x01",
      7);
  const std::string file = write("a.rawlog", bytes);
  const Outcome outcome = run(kPlay + " --json " + file);
  EXPECT_EQ(outcome.code, 5) << outcome.err;
  EXPECT_NE(outcome.out.find("\"entries\": 10"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("entry 10: unknown class 'CCake'"), std::string::npos) << outcome.err;
  expect_rejected(run(kPlay + " --input-policy strict " + file), "entry 10: unknown class");
}

TEST_F(RejectedRawlog, TruncatedLogKeepsWhatCameBefore) {
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

TEST_F(RejectedRawlog, CorruptBytesNeverCrash) {
  const std::string good = read_all(kGoodLog);
  std::mt19937 random(2);
  for (int trial = 0; trial < 15; ++trial) {
    std::string bytes = good;
    for (int i = 0; i < 10; ++i)
      bytes[random() % bytes.size()] = static_cast<char>(random() & 0xFFU);
    const Outcome outcome = run(kPlay + " " + write("a.rawlog", bytes));
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 4 || outcome.code == 5)
        << outcome.code << " " << outcome.err;
  }
}

TEST_F(RejectedRawlog, CorruptBytesInAnUncompressedLogNeverCrash) {
  ASSERT_EQ(run("gzip -dc " + kGoodLog).code, 0);
  const std::string good = read_all(path("out"));
  std::mt19937 random(3);
  for (int trial = 0; trial < 30; ++trial) {
    std::string bytes = good;
    for (int i = 0; i < 5; ++i)
      bytes[random() % bytes.size()] = static_cast<char>(random() & 0xFFU);
    const Outcome outcome = run(kPlay + " " + write("a.rawlog", bytes));
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 4 || outcome.code == 5)
        << outcome.code << " " << outcome.err;
  }
}

TEST_F(RejectedRawlog, EntryThatClaimsGigabytes) {
  if (!MemoryBudget::supported()) GTEST_SKIP() << "no memory budget under this sanitizer";
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
  expect_rejected(run(kPlay + " " + write("a.rawlog", bytes)),
                  "entry 0: this entry asks for more than");
  rusage used{};
  ASSERT_EQ(getrusage(RUSAGE_CHILDREN, &used), 0);
  // [KiB]: the 512 MiB that the guard grants to one entry, and the program itself.
  EXPECT_LT(used.ru_maxrss, 700 * 1024);
}

TEST_F(RejectedRawlog, GzipBombEndsTheLog) {
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
  expect_rejected(run(kPlay + " --input-policy strict " + path("bomb.rawlog")),
                  "expands more than");
}

TEST_F(RejectedRawlog, NonFiniteOdometry) {
  const std::string file = odometry_log(10, [](int i, auto& o) {
    if (i == 4) o.odometry.x(std::numeric_limits<double>::quiet_NaN());
  });
  const Outcome outcome = run(kPlay + " " + file);
  EXPECT_EQ(outcome.code, 5);
  EXPECT_NE(outcome.err.find("entry 4: odometry is not finite"), std::string::npos) << outcome.err;
  expect_rejected(run(kPlay + " --input-policy strict " + file), "entry 4: odometry is not finite");
}

TEST_F(RejectedRawlog, TimeGoingBackwards) {
  const std::string file = odometry_log(10, [](int i, auto& o) {
    if (i == 6) o.timestamp = mrpt::Clock::fromDouble(10.0);
  });
  EXPECT_EQ(run(kPlay + " " + file).code, 5);
  EXPECT_EQ(run(kPlay + " --input-policy repair " + file).code, 0);
  expect_rejected(run(kPlay + " --input-policy strict " + file),
                  "entry 6: odometry goes back in time");
}

}  // namespace
}  // namespace libslam
