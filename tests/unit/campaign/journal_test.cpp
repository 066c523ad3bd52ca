#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <support/temporary_directory.hpp>

#include <gtest/gtest.h>

#include <libslam/campaign/journal.hpp>

namespace libslam {
namespace {

namespace fs = std::filesystem;

const std::string kPlan(64, 'a'), kOther(64, 'b');

class JournalFile : public testing::Test {
 protected:
  static Journal::Record record(std::uint64_t number, std::size_t length) {
    return {number, std::vector<std::uint8_t>(length, static_cast<std::uint8_t>(number))};
  }
  void write(std::initializer_list<std::uint64_t> numbers) const {
    Journal journal(file_, kPlan);
    for (const std::uint64_t number : numbers) journal.append(record(number, 100));
  }
  std::vector<std::uint64_t> numbers() const {
    Journal journal(file_, kPlan);
    std::vector<std::uint64_t> found;
    for (const Journal::Record& r : journal.take_records()) {
      EXPECT_EQ(r.bytes, record(r.number, 100).bytes);
      found.push_back(r.number);
    }
    EXPECT_TRUE(journal.take_records().empty());
    return found;
  }
  std::string error(const std::string& digest = kPlan) const {
    try {
      Journal journal(file_, digest);
    } catch (const std::runtime_error& failure) {
      return failure.what();
    }
    return "";
  }

  test::TemporaryDirectory directory_;
  fs::path file_ = directory_.path() / "runs.journal";
};

using Numbers = std::vector<std::uint64_t>;

TEST_F(JournalFile, GivesBackWhatWasAppendedInEverySession) {
  write({3, 1});
  write({2});
  EXPECT_EQ(numbers(), (Numbers{3, 1, 2}));
}

TEST_F(JournalFile, RecordThatACrashCutOffIsDroppedWhereverItWasCut) {
  write({1});
  const auto whole = fs::file_size(file_);
  write({2});
  for (auto size = fs::file_size(file_) - 1; size >= whole; --size) {
    fs::resize_file(file_, size);
    EXPECT_EQ(numbers(), Numbers{1}) << "cut at " << size;
    EXPECT_EQ(fs::file_size(file_), whole);
    fs::resize_file(file_, size);  // zeros: what a file system may leave after a power failure
    EXPECT_EQ(numbers(), Numbers{1}) << "zeros from " << whole << " to " << size;
  }
  write({3});
  EXPECT_EQ(numbers(), (Numbers{1, 3}));
}

TEST_F(JournalFile, GarbledRecordIsDropped) {
  write({1, 2});
  const auto size = fs::file_size(file_);
  for (const std::uintmax_t from_end : {1U, 50U, 105U, 130U}) {
    {
      std::fstream stream(file_, std::ios::binary | std::ios::in | std::ios::out);
      stream.seekp(static_cast<std::streamoff>(size - from_end));
      stream.put('\x7f');
    }
    EXPECT_EQ(numbers(), Numbers{1}) << from_end;
    write({2});
    EXPECT_EQ(numbers(), (Numbers{1, 2}));
  }
}

TEST_F(JournalFile, TitleThatACrashCutOffIsWrittenAgain) {
  for (const std::size_t length : {0U, 5U, 40U}) {
    directory_.write("runs.journal", ("libslam campaign journal 2 " + kPlan).substr(0, length));
    EXPECT_EQ(numbers(), Numbers{});
    write({1});
    EXPECT_EQ(numbers(), Numbers{1});
    fs::remove(file_);
  }
}

TEST_F(JournalFile, ForeignFilesAreRefusedAndLeftAlone) {
  write({1});
  const auto size = fs::file_size(file_);
  EXPECT_NE(error(kOther).find("runs.journal: belongs to another"), std::string::npos);
  EXPECT_EQ(fs::file_size(file_), size);
  directory_.write("runs.journal", "something else altogether");
  EXPECT_NE(error().find("belongs to another"), std::string::npos);
  Journal replaced(file_, kPlan, Journal::Opening::kReplace);
  EXPECT_TRUE(replaced.take_records().empty());
}

TEST_F(JournalFile, TwoProcessesCannotWriteToOne) {
  {
    const Journal journal(file_, kPlan);
    EXPECT_NE(error().find("another slam-campaign is at work"), std::string::npos);
    EXPECT_THROW(Journal(file_, kPlan, Journal::Opening::kReplace), std::runtime_error);
  }
  EXPECT_EQ(error(), "");
}

TEST_F(JournalFile, UnwritablePlaceIsNamed) {
  file_ = directory_.path() / "none" / "runs.journal";
  EXPECT_NE(error().find("none/runs.journal: cannot be written"), std::string::npos);
}

TEST_F(JournalFile, FullDiskIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  fs::create_symlink("/dev/full", file_);
  EXPECT_NE(error(), "");
}

}  // namespace
}  // namespace libslam
