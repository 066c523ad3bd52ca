#pragma once
// Runs programs and judges what a user sees of them.

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <support/temporary_directory.hpp>
#include <sys/wait.h>

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/serialization/CArchive.h>

namespace libslam::test {

inline const std::string kGoodLog = "/usr/share/mrpt/datasets/kf-slam_demo.rawlog";

struct Outcome {
  int code = -1;
  std::string out, err;
};

inline std::string read_all(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class ProgramTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  std::string write(const std::string& name, const std::string& bytes) const {
    return directory_.write(name, bytes).string();
  }

  Outcome run(const std::string& command) const {
    const int status =
        std::system((command + " >" + path("out") + " 2>" + path("err") + " </dev/null").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_all(path("out")),
            read_all(path("err"))};
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

  TemporaryDirectory directory_;
};

}  // namespace libslam::test
