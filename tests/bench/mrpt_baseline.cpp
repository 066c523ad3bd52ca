// mrpt-baseline CONFIG RAWLOG --out DIR: MRPT's own CRangeBearingKFSLAM2D on a log, with the motion
// noise, the sensor sigmas and the gate of CONFIG, into a run directory that slam-evaluate compares
// with ours.

#include <ctime>
#include <iostream>

#include <CLI/CLI.hpp>

#include <libslam/config/yaml_loader.hpp>
#include <libslam/io/rawlog_player.hpp>
#include <libslam/io/truth_reader.hpp>
#include <libslam/pipeline/landmark_identity.hpp>
#include <libslam/pipeline/mrpt_filter.hpp>
#include <libslam/result/atomic_file.hpp>
#include <libslam/result/recorder.hpp>

namespace {

using namespace libslam;
int run(const std::string& config, const std::string& rawlog, const std::string& directory) {
  Parameters parameters = load_yaml(config);
  MrptFilter filter(parameters);

  RawlogPlayer player(rawlog);
  Recorder recorder({directory, true, 0.0, true});
  replace_file(std::filesystem::path(directory) / "config.yaml", to_yaml(parameters));
  double cpu_s = 0.0;
  std::int64_t index = 0;
  while (const auto step = player.next()) {
    const std::clock_t begin = std::clock();
    auto record = filter.process(*step);
    const double spent = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    cpu_s += spent;
    if (!record) continue;
    record->step_ms = 1e3 * spent;
    recorder.record(*record);
    ++index;
  }
  RunSummary summary;
  summary.program = "mrpt-baseline";
  summary.version = "MRPT";
  summary.input.file = rawlog;
  summary.timing.cpu_s = cpu_s;
  summary.timing.steps = index;
  const auto identity = landmark_identity(parameters);
  const LandmarkMap map = filter.landmarks();
  recorder.finish(summary, map, read_truth(find_truth(rawlog)), identity);
  std::cout << map.size() << " landmarks, " << cpu_s << " s CPU in the filter, " << directory
            << '\n';
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("MRPT's CRangeBearingKFSLAM2D on a log, for comparison.");
  std::string config, rawlog, out;
  app.add_option("config", config)->required();
  app.add_option("rawlog", rawlog)->required();
  app.add_option("--out", out)->required();
  CLI11_PARSE(app, argc, argv);
  try {
    return run(config, rawlog, out);
  } catch (const std::exception& e) {
    std::cerr << "mrpt-baseline: " << e.what() << '\n';
    return 1;
  }
}
