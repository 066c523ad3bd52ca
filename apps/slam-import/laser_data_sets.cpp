#include <iostream>
#include <map>
#include <memory>
#include <string>

#include <libslam/io/importers/carmen.hpp>

#include "command.hpp"

namespace {

using namespace libslam;

bool convert_carmen(const CommonArguments& arguments, const CarmenOptions& options,
                    const Interrupted& interrupted) {
  const CarmenSummary done =
      import_carmen(arguments.directory, arguments.out, options, interrupted);
  if (arguments.quiet) return done.complete;
  std::cout << arguments.out << ": " << done.scans << " scans, " << done.odometry
            << " odometry readings, " << done.relations << " relations, " << done.reference_poses
            << " reference poses";
  if (done.mended_times > 0) std::cout << "; " << done.mended_times << " late time stamps mended";
  std::cout << '\n';
  std::map<std::string, std::string> left_out;
  for (const auto& [kind, count] : done.left_out)
    left_out["left out, " + kind] = std::to_string(count);
  print_notes(arguments, {}, left_out);
  return done.complete;
}

void add_carmen(CLI::App& app, CommonArguments& arguments, Commands& commands) {
  using Odometry = CarmenOptions::Odometry;
  const auto options = std::make_shared<CarmenOptions>();
  auto* sub = add_subcommand(app, arguments, "carmen", "CARMEN log with laser scans",
                             {.name = "log", .text = "Log file, .clf or .clf.gz"});
  sub->add_option("--odometry", options->odometry,
                  "scans: the pose attached to every scan; messages: ODOM, interpolated at scans")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Odometry>{
          {"scans", Odometry::kScans}, {"messages", Odometry::kMessages}}));
  sub->add_option("--max-range", options->max_range, "Longer ranges are no returns [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  sub->add_option(
      "--relations", options->relations,
      "Relations of the Freiburg SLAM benchmark; default: LOG.relations, if it is there");
  sub->add_option("--reference", options->reference,
                  "The log as a mapper corrected it: its poses become X.truth.tum, a reference and "
                  "no ground truth");
  commands.push_back(
      {sub, [options](const CommonArguments& common, const Interrupted& interrupted) {
         return convert_carmen(common, *options, interrupted);
       }});
}

}  // namespace

void add_laser_data_sets(CLI::App& app, CommonArguments& arguments, Commands& commands) {
  add_carmen(app, arguments, commands);
}
