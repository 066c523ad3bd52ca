#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <stdexcept>
#include <string_view>
#include <sys/file.h>
#include <unistd.h>

#include <libslam/campaign/journal.hpp>
#include <libslam/config/digest.hpp>

namespace libslam {

namespace {

constexpr std::string_view kMagic = "libslam campaign journal 2 ";
constexpr std::size_t kChecksumLength = 16;  // hexadecimal digits: 64 bits

struct Head {
  std::uint64_t number = 0, length = 0;
  std::array<char, kChecksumLength> checksum{};
};

Head head_of(const Journal::Record& record) {
  Head head{record.number, record.bytes.size(), {}};
  std::string covered(2 * sizeof(std::uint64_t) + record.bytes.size(), '\0');
  std::memcpy(covered.data(), &head, 2 * sizeof(std::uint64_t));
  std::copy(record.bytes.begin(), record.bytes.end(), covered.begin() + 2 * sizeof(std::uint64_t));
  sha256_of_text(covered).copy(head.checksum.data(), kChecksumLength);
  return head;
}

/// False at the end of what is whole; `left`: bytes of the file behind this point.
bool read_record(std::istream& in, std::uintmax_t left, Journal::Record& record) {
  Head head;
  if (left < sizeof(head) || !in.read(reinterpret_cast<char*>(&head), sizeof(head))) return false;
  if (head.length > left - sizeof(head)) return false;
  record.number = head.number;
  record.bytes.resize(head.length);
  if (!in.read(reinterpret_cast<char*>(record.bytes.data()),
               static_cast<std::streamsize>(record.bytes.size())))
    return false;
  return head_of(record).checksum == head.checksum;
}

}  // namespace

Journal::Journal(const std::filesystem::path& file, const std::string& digest, Opening opening)
    : file_(file) {
  open_alone();
  const std::string title = std::string(kMagic) + digest + "\n";
  try {
    const std::uintmax_t good = opening == Opening::kReplace ? 0 : read(title);
    std::filesystem::resize_file(file, good);
    out_.open(file, std::ios::binary | std::ios::app);
    if (good == 0) out_ << title << std::flush;
    if (!out_) throw std::runtime_error(file.string() + ": cannot be written");
  } catch (...) {
    close(lock_);
    throw;
  }
}

Journal::~Journal() {
  close(lock_);
}

/// Two processes that append to one file would spoil it.
void Journal::open_alone() {
  lock_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0)
    throw std::runtime_error(file_.string() + ": cannot be written: " + std::strerror(errno));
  // A file system without locks (some of clusters) must not stop the work.
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(lock_);
    throw std::runtime_error(file_.string() + ": another slam-campaign is at work on it");
  }
}

/// Fills `records_`; the length of what is whole, 0 where not even the title is.
std::uintmax_t Journal::read(const std::string& title) {
  std::ifstream in(file_, std::ios::binary);
  std::string found(title.size(), '\0');
  in.read(found.data(), static_cast<std::streamsize>(found.size()));
  found.resize(static_cast<std::size_t>(in.gcount()));
  if (!title.starts_with(found))
    throw std::runtime_error(file_.string() +
                             ": belongs to another campaign, other settings or another version of "
                             "the program; choose a new directory, or --force to start over");
  if (found.size() < title.size()) return 0;
  std::uintmax_t good = title.size();
  const std::uintmax_t size = std::filesystem::file_size(file_);
  for (Record record; read_record(in, size - good, record);) {
    good += sizeof(Head) + record.bytes.size();
    records_.push_back(std::move(record));
  }
  return good;
}

void Journal::append(const Record& record) {
  const Head head = head_of(record);
  out_.write(reinterpret_cast<const char*>(&head), sizeof(head));
  out_.write(reinterpret_cast<const char*>(record.bytes.data()),
             static_cast<std::streamsize>(record.bytes.size()));
  out_.flush();
  if (!out_) throw std::runtime_error(file_.string() + ": cannot be written");
}

}  // namespace libslam
