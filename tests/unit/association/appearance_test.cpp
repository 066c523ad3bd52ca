#include <random>
#include <tests/support/pairwise_compatibility.hpp>

#include <gtest/gtest.h>

#include <libslam/association/appearance.hpp>

using namespace libslam;

namespace {

/// The same squared distance for every pair, or one by hand.
class Everywhere final : public libslam::testing::PairwiseCompatibility {
 public:
  explicit Everywhere(double distance2) : distance2_(distance2) {}
  std::optional<Match> test(std::size_t, std::size_t, double limit) override {
    ++tests;
    if (distance2_ > 10.0 * limit) return std::nullopt;
    return Match{distance2_, 0.0};
  }
  int tests = 0;

 private:
  double distance2_;
};

using Appearance = std::shared_ptr<Descriptor>;

Appearance random_bits(std::mt19937_64& random) {
  auto d = std::make_shared<Descriptor>();
  d->size = 32;
  for (int i = 0; i < 32; ++i)
    d->bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(random());
  return d;
}

/// The same with the first `count` bits turned over.
Appearance with_flips(const Appearance& original, int count) {
  auto d = std::make_shared<Descriptor>(*original);
  for (int i = 0; i < count; ++i)
    d->bytes[static_cast<std::size_t>(i / 8)] ^= static_cast<std::uint8_t>(1U << (i % 8));
  return d;
}

Feature feature_like(const Appearance& appearance) {
  Feature feature;
  feature.appearance = appearance;
  return feature;
}

class AppearanceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::mt19937_64 random(2);
    for (int i = 0; i < 20; ++i) {
      known_.push_back(random_bits(random));
      registry_.add(BlockId{i}, kNoIdentity, known_.back());
    }
    stranger_ = random_bits(random);
  }
  std::vector<Verdict> associate(const std::vector<Feature>& features, double distance2 = 1.0) {
    Everywhere place(distance2);
    std::vector<Verdict> verdicts;
    AppearanceAssociation(11.3, 0.25, 0.8).associate(features, registry_, place, verdicts);
    return verdicts;
  }

  LandmarkRegistry registry_{1, 0};
  std::vector<Appearance> known_;
  Appearance stranger_;
};

TEST_F(AppearanceTest, FindsLandmarksThroughNoise) {
  std::vector<Feature> features;
  for (std::size_t i = 20; i-- > 0;) features.push_back(feature_like(with_flips(known_[i], 40)));
  const auto verdicts = associate(features);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(verdicts[i].outcome, Outcome::kPaired);
    EXPECT_EQ(verdicts[i].landmark, 19 - i);
  }
}

TEST_F(AppearanceTest, NewGatedAndWithoutAppearance) {
  const auto verdicts = associate({feature_like(stranger_), Feature{}});
  EXPECT_EQ(verdicts[0].outcome, Outcome::kNew);
  EXPECT_EQ(verdicts[1].outcome, Outcome::kAmbiguous);
  // Looks right and stands wrong: near the gate, and far beyond it.
  for (const double distance2 : {11.4, 1e6}) {
    const auto moved = associate({feature_like(known_[3])}, distance2);
    EXPECT_EQ(moved[0].outcome, Outcome::kGated);
    EXPECT_EQ(moved[0].landmark, 3U);
  }
}

TEST_F(AppearanceTest, TwinsAreAmbiguous) {
  registry_.add(BlockId{20}, kNoIdentity, with_flips(known_[3], 10));
  EXPECT_EQ(associate({feature_like(with_flips(known_[3], 5))})[0].outcome, Outcome::kAmbiguous);
}

TEST_F(AppearanceTest, NoLandmarkIsPairedTwice) {
  const auto verdicts =
      associate({feature_like(with_flips(known_[3], 30)), feature_like(with_flips(known_[3], 10)),
                 feature_like(with_flips(known_[4], 30))});
  EXPECT_EQ(verdicts[0].outcome, Outcome::kAmbiguous);
  EXPECT_EQ(verdicts[1].outcome, Outcome::kPaired);
  EXPECT_EQ(verdicts[1].landmark, 3U);
  EXPECT_EQ(verdicts[2].outcome, Outcome::kPaired);
  EXPECT_EQ(verdicts[2].landmark, 4U);
}

TEST_F(AppearanceTest, OtherKindsOfDescriptorsNeverMatch) {
  auto numbers = std::make_shared<Descriptor>(*known_[0]);
  numbers->kind = Descriptor::Kind::kNumbers;
  EXPECT_EQ(associate({feature_like(numbers)})[0].outcome, Outcome::kNew);
}

TEST_F(AppearanceTest, RegistryKeepsTheLastSighting) {
  EXPECT_EQ(registry_.landmarks()[2].appearance, known_[2]);
  registry_.record_sighting(2, stranger_);
  EXPECT_EQ(registry_.landmarks()[2].appearance, stranger_);
  registry_.record_sighting(2);
  EXPECT_EQ(registry_.landmarks()[2].appearance, stranger_);
}

TEST(Descriptor, RelativeDistance) {
  Descriptor a, b;
  a.size = b.size = 32;
  b.bytes[0] = 0xFF;
  EXPECT_DOUBLE_EQ(relative_distance(a, b), 8.0 / 256.0);
  a.kind = b.kind = Descriptor::Kind::kNumbers;
  EXPECT_DOUBLE_EQ(relative_distance(a, b), 255.0 / 512.0);
}

TEST(AppearanceAssociation, RefusesSenselessLimits) {
  EXPECT_THROW(AppearanceAssociation(0.0, 0.3, 0.8), std::invalid_argument);
  EXPECT_THROW(AppearanceAssociation(9.0, 0.0, 0.8), std::invalid_argument);
  EXPECT_THROW(AppearanceAssociation(9.0, 0.3, 1.1), std::invalid_argument);
}

}  // namespace
