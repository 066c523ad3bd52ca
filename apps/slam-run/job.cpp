#include "job.hpp"

#include <filesystem>
#include <utility>

#include <libslam/config/ini_loader.hpp>
#include <libslam/config/validation.hpp>
#include <libslam/config/yaml_loader.hpp>

namespace libslam {

namespace fs = std::filesystem;

bool is_config(const std::string& file) {
  const std::string extension = fs::path(file).extension();
  return extension == ".yaml" || extension == ".yml" || extension == ".ini";
}

Job load_job(Arguments& arguments) {
  Job job;
  ParameterPlaces places;
  if (!is_config(arguments.config) && (arguments.rawlog.empty() || is_config(arguments.rawlog)))
    std::swap(arguments.rawlog, arguments.config);
  const std::string extension = fs::path(arguments.config).extension();
  if (extension == ".ini") {
    KfSlamIni ini = load_kf_slam_ini(arguments.config);
    job.parameters = ini.parameters;
    job.notes = ini.notes;
    if (arguments.rawlog.empty()) arguments.rawlog = ini.rawlog_file.value_or("");
    job.truth.path = ini.ground_truth_file_robot.value_or("");
    job.truth.landmarks = ini.ground_truth_file.value_or("");
  } else if (!arguments.config.empty()) {
    job.parameters = load_yaml(arguments.config, &places);
  }
  for (const auto& setting : arguments.settings) set_parameter(job.parameters, setting, &places);
  if (!arguments.input_policy.empty())
    set_parameter(job.parameters, "input.policy=" + arguments.input_policy, &places);
  if (!arguments.load_map.empty())
    set_parameter(job.parameters, "map.file=" + arguments.load_map, &places);
  validate(job.parameters, places);
  const TruthFiles beside = arguments.rawlog.empty() ? TruthFiles{} : find_truth(arguments.rawlog);
  job.truth.notes = beside.notes;
  job.truth.notes_describe_path = job.truth.path.empty() && arguments.truth.empty();
  job.truth.relations = beside.relations;
  if (job.truth.path.empty()) job.truth.path = beside.path;
  if (job.truth.landmarks.empty()) job.truth.landmarks = beside.landmarks;
  if (!arguments.truth.empty()) job.truth.path = arguments.truth;
  if (!arguments.truth_map.empty()) job.truth.landmarks = arguments.truth_map;
  return job;
}

}  // namespace libslam
