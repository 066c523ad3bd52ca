#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include <libslam/config/validation.hpp>

namespace libslam {
namespace {

Parameters images() {
  Parameters p;
  p.frontend.source = "stereo_images";
  p.measurement.model = "stereo_point";
  return p;
}

/// Some conflict names this key.
bool objects_to(const Parameters& p, const std::string& key) {
  const auto conflicts = find_conflicts(p);
  return std::ranges::any_of(conflicts, [&](const Conflict& conflict) {
    return std::ranges::find(conflict.keys, key) != conflict.keys.end();
  });
}

TEST(ImageRules, SoundCombinations) {
  Parameters p = images();
  EXPECT_TRUE(find_conflicts(p).empty());
  p.frontend.stereo.tracker = "klt";
  EXPECT_TRUE(find_conflicts(p).empty());
  p.association.method = "appearance";
  EXPECT_TRUE(find_conflicts(p).empty());
  p = images();
  p.frontend.source = "fiducials";
  EXPECT_TRUE(find_conflicts(p).empty());
}

TEST(ImageRules, IllegalCombinations) {
  Parameters p = images();
  p.frontend.stereo.delivered = p.frontend.stereo.detected + 1;
  EXPECT_TRUE(objects_to(p, "frontend.stereo.delivered"));
  p = images();
  p.frontend.stereo.tracker = "klt";
  p.frontend.stereo.detector = "sift";
  EXPECT_TRUE(objects_to(p, "frontend.stereo.detector"));
  p = images();
  p.frontend.stereo.max_distance = 0.0;
  EXPECT_TRUE(objects_to(p, "frontend.stereo.max_distance"));
  p = images();
  p.frontend.source = "fiducials";
  p.association.method = "nearest_neighbour";
  EXPECT_TRUE(objects_to(p, "association.method"));
  p = images();
  p.frontend.source = "stereo_points";
  p.association.method = "appearance";
  EXPECT_TRUE(objects_to(p, "association.method"));
  p = images();
  p.measurement.model = "range_bearing";
  EXPECT_TRUE(objects_to(p, "measurement.model"));
  p = images();
  p.frontend.fiducials.family = "tag99";
  EXPECT_TRUE(objects_to(p, "frontend.fiducials.family"));
}

}  // namespace
}  // namespace libslam
