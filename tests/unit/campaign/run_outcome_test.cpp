#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <libslam/campaign/run_outcome.hpp>

namespace libslam {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(RunOutcome, BytesKeepEveryBit) {
  RunOutcome outcome;
  outcome.retried = true;
  outcome.variants.resize(2);
  outcome.variants[1].status = "failed: \xff is no UTF-8";
  VariantOutcome& v = outcome.variants[0];
  v.status = "done";
  v.figures["truth"] = {{"ate_rmse_m", 0.1}, {"matched", 7}};
  v.figures["health"] = {{"nis_mean", 2.0}};
  v.sums = {1e-300, 3.0, 1.0 / 3.0, 936};
  v.nees = {kNan, 3.0, 0.1, kInfinity, std::numeric_limits<double>::denorm_min()};
  v.series.times = {0.0, 0.2};
  v.series.errors = {{{0.1, -0.0}, {kNan, 1.0}, {2.0, 3.0}}};
  v.series.sigmas = {{{0.1, 0.2}, {0.3, 0.4}, {0.5, 0.6}}};

  const auto bytes = to_bytes(outcome);
  const RunOutcome back = outcome_from_bytes(bytes);
  EXPECT_EQ(to_bytes(back), bytes);
  ASSERT_EQ(back.variants.size(), 2U);
  const VariantOutcome& w = back.variants[0];
  EXPECT_TRUE(back.retried);
  EXPECT_TRUE(w.done());
  EXPECT_EQ(w.figures.dump(), v.figures.dump());  // 2.0 stays a real number
  EXPECT_EQ(w.sums.x, 1e-300);
  EXPECT_EQ(w.sums.heading, 1.0 / 3.0);
  EXPECT_EQ(w.sums.count, 936);
  ASSERT_EQ(w.nees.size(), 5U);
  EXPECT_TRUE(std::isnan(w.nees[0]));
  for (std::size_t i = 1; i < 5; ++i) EXPECT_EQ(w.nees[i], v.nees[i]);
  EXPECT_TRUE(std::signbit(w.series.errors[0][1]));
  EXPECT_TRUE(std::isnan(w.series.errors[1][0]));
  EXPECT_EQ(w.series.sigmas, v.series.sigmas);
  EXPECT_TRUE(back.variants[1].failed());
  EXPECT_EQ(back.variants[1].status, outcome.variants[1].status);
}

TEST(RunOutcome, OtherBytesAreRefused) {
  EXPECT_THROW(outcome_from_bytes({}), nlohmann::json::exception);
  EXPECT_THROW(outcome_from_bytes({0xff, 0x00, 0x17}), nlohmann::json::exception);
  auto bytes = to_bytes({false, {{"done", {}, {}, {1.0}, {}}}});
  bytes.pop_back();
  EXPECT_THROW(outcome_from_bytes(bytes), nlohmann::json::exception);
  EXPECT_THROW(outcome_from_bytes(nlohmann::json::to_cbor({{"retried", false}})),
               nlohmann::json::exception);
}

}  // namespace
}  // namespace libslam
