#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>

#include <libslam/io/importers/kitti_features.hpp>
#include <libslam/io/importers/kitti_images.hpp>
#include <libslam/io/importers/starry_night.hpp>

#include "command.hpp"

namespace {

using namespace libslam;

bool write(const CommonArguments& arguments, const SpatialLog& log,
           const Interrupted& interrupted) {
  const bool complete = write_spatial_log(log, arguments.out, interrupted);
  if (arguments.quiet) return complete;
  std::size_t sightings = 0;
  for (const SpatialStep& step : log.steps) sightings += step.sightings.size();
  std::cout << arguments.out << ": " << log.scenario << ", " << log.steps.size() << " steps with "
            << sightings << " stereo points, " << log.truth.path.spatial.size() << " true poses, "
            << log.truth.landmarks.size() << " true landmarks\n";
  print_notes(arguments, log.parameters, log.remarks);
  return complete;
}

void add_starry_night(CLI::App& app, CommonArguments& arguments, Commands& commands) {
  auto* sub = add_subcommand(app, arguments, "starry-night", "UTIAS Starry Night");
  const auto seed = std::make_shared<std::optional<std::uint64_t>>();
  sub->add_option("--simulate-pixels", *seed,
                  "Replace the pixels by true projections with white noise of the stated "
                  "variances, from this seed");
  commands.push_back({sub, [seed](const CommonArguments& common, const Interrupted& interrupted) {
                        SpatialLog log = import_starry_night(common.directory);
                        if (*seed) simulate_pixels(log, starry_night_sigma(log), **seed);
                        return write(common, log, interrupted);
                      }});
}

bool convert_kitti_images(const CommonArguments& arguments, const Interrupted& interrupted) {
  const KittiImagesSummary done =
      import_kitti_images(arguments.directory, arguments.out, interrupted);
  if (!arguments.quiet)
    std::cout << arguments.out << ": " << done.pairs << " pairs of images, baseline "
              << done.baseline << " m, " << done.true_poses << " true poses\n";
  return done.complete;
}

}  // namespace

void add_spatial_data_sets(CLI::App& app, CommonArguments& arguments, Commands& commands) {
  add_starry_night(app, arguments, commands);
  auto* kitti = add_subcommand(app, arguments, "kitti-features",
                               "Tracked stereo points and velocities of a KITTI drive");
  commands.push_back({kitti, [](const CommonArguments& common, const Interrupted& interrupted) {
                        return write(common, import_kitti_features(common.directory), interrupted);
                      }});
  auto* images = add_subcommand(app, arguments, "kitti-images",
                                "Stereo images of the KITTI odometry benchmark");
  commands.push_back({images, convert_kitti_images});
}
