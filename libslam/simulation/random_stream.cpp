#include <libslam/simulation/random_stream.hpp>

namespace libslam {

namespace {

constexpr int kRounds = 10;
constexpr unsigned kPurposeBits = 8;

std::uint32_t low(std::uint64_t value) {
  return static_cast<std::uint32_t>(value);
}
std::uint32_t high(std::uint64_t value) {
  return static_cast<std::uint32_t>(value >> 32U);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, RandomPurpose purpose, std::uint64_t step,
                           std::uint32_t element)
    : key_{low(seed), high(seed)},
      counter_{0, element, low(step),
               (high(step) << kPurposeBits) | static_cast<std::uint32_t>(purpose)} {}

void RandomStream::refill() {
  constexpr std::uint64_t kMultiplier0 = 0xD2511F53U, kMultiplier1 = 0xCD9E8D57U;
  constexpr std::uint32_t kWeyl0 = 0x9E3779B9U, kWeyl1 = 0xBB67AE85U;
  Counter c = counter_;
  Key k = key_;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t product0 = kMultiplier0 * c[0], product1 = kMultiplier1 * c[2];
    c = {high(product1) ^ c[1] ^ k[0], low(product1), high(product0) ^ c[3] ^ k[1], low(product0)};
    k[0] += kWeyl0;
    k[1] += kWeyl1;
  }
  block_ = c;
  ++counter_[0];
  used_ = 0;
}

RandomStream::result_type RandomStream::operator()() {
  if (used_ == block_.size()) refill();
  const std::uint64_t value =
      (static_cast<std::uint64_t>(block_[used_ + 1]) << 32U) | block_[used_];
  used_ += 2;
  return value;
}

}  // namespace libslam
