// association-comparison [--frames N] [--mrpt-frames N]: joint compatibility, nearest neighbour and
// MRPT's JCBB on the same random frames; wrong pairs and CPU time by kind of scene.

#include <cstdio>
#include <string>
#include <support/association_score.hpp>
#include <vector>

#include <CLI/CLI.hpp>

namespace {

using namespace libslam;
using namespace libslam::testing;

struct Row {
  std::string name;
  AssociationSceneOptions options;
  bool mrpt = true;  // false: takes it too long
};

AssociationSceneOptions scene(int landmarks, double area, double range, int observations,
                              int unmapped, double sigma = 0.3, double sigma_heading_deg = 3.0) {
  AssociationSceneOptions options;
  options.landmarks = landmarks;
  options.area_per_landmark = area;
  options.max_range = range;
  options.observations = observations;
  options.unmapped = unmapped;
  options.sigma_position = sigma;
  options.sigma_heading = sigma_heading_deg * 3.14159265358979323846 / 180.0;
  return options;
}

void print(const char* method, const AssociationScore& score) {
  std::printf(
      "  %-20s %6.2f %% wrong  %6.1f %% right  %5.2f %% wrongly new  %8.3f ms median  "
      "%9.3f ms slowest\n",
      method, 100.0 * score.wrong_share(), 100.0 * score.right_share(),
      100.0 * static_cast<double>(score.wrongly_new) /
          static_cast<double>(std::max(1L, score.mapped)),
      score.median_ms(), score.slowest_ms());
}

void compare(const Row& row, int frames, int mrpt_frames) {
  JointCompatibilityOptions gates;
  JointCompatibility joint(gates);
  NearestNeighbour nearest(chi_square_quantile(gates.gate_probability, 2),
                           chi_square_quantile(gates.new_landmark_probability, 2));
  AssociationScore ours, simple, mrpt;
  for (int frame = 0; frame < frames; ++frame) {
    AssociationScene drawn(row.options, 1000 + static_cast<std::uint64_t>(frame));
    if (drawn.features.empty()) continue;
    score(joint, drawn, ours);
    score(nearest, drawn, simple);
    if (row.mrpt && frame < mrpt_frames) score_mrpt(drawn, gates.gate_probability, mrpt);
  }
  std::printf("%s\n", row.name.c_str());
  print("joint_compatibility", ours);
  print("nearest_neighbour", simple);
  if (row.mrpt) print("MRPT assocJCBB", mrpt);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Association of single frames: libslam and MRPT on the same random scenes.");
  int frames = 300, mrpt_frames = 100;
  app.add_option("--frames", frames, "frames of each scene")->capture_default_str();
  app.add_option("--mrpt-frames", mrpt_frames, "of these, for MRPT")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  const std::vector<Row> rows{
      {"16 m2 per landmark, 9 observations, pose .3 m / 3 deg", scene(60, 16, 15, 9, 0)},
      {"same, 3 of 12 observations unmapped", scene(60, 16, 15, 9, 3)},
      {"6 m2 per landmark, 9 observations", scene(100, 6, 15, 9, 0)},
      {"2 m2 per landmark, 9 observations within 8 m", scene(60, 2, 8, 9, 0)},
      {"6 m2 per landmark, 6 of 26 observations unmapped", scene(100, 6, 15, 20, 6), false},
      {"2 m2 per landmark, 10 of 40 observations unmapped", scene(200, 2, 15, 30, 10), false},
      {"3 m2 per landmark, 30 observations, pose 1 m / 6 deg", scene(200, 3, 15, 30, 0, 1, 6),
       false}};
  for (const Row& row : rows) compare(row, frames, mrpt_frames);
  return 0;
}
