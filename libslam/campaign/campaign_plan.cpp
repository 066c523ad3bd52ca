#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>

#include <libslam/campaign/campaign_draft.hpp>
#include <libslam/campaign/campaign_plan.hpp>
#include <libslam/config/digest.hpp>
#include <libslam/config/text_file.hpp>
#include <libslam/config/validation.hpp>
#include <libslam/config/version.hpp>
#include <libslam/config/yaml_loader.hpp>
#include <libslam/pipeline/simulation.hpp>

namespace libslam {

namespace {

constexpr std::size_t kMostPoints = 10'000, kMostLogs = 1'000'000;

/// A node that is a file name or a mapping, over the values in `table`.
template <class Table>
void apply_node(const Table& table, const YamlNode& node, const std::filesystem::path& file) {
  if (node.kind == YamlNode::Kind::kScalar && !node.is_null())
    load_yaml(table, file.parent_path() / node.text);
  else if (node.kind == YamlNode::Kind::kMapping)
    load_yaml(table, node, file.string());
}

Scenario make_scenario(const CampaignDraft& draft) {
  Scenario scenario;
  apply_node(ParameterTable(scenario), draft.scenario, draft.file);
  const bool is_file = draft.scenario.kind == YamlNode::Kind::kScalar;
  const auto origin =
      is_file ? draft.file.parent_path() / draft.scenario.text : std::filesystem::path(draft.file);
  resolve_world_files(scenario, origin.parent_path());
  for (const std::string& setting : draft.scenario_settings)
    set_parameter(ParameterTable(scenario), setting);
  return scenario;
}

const char* engine_note(Engine engine) {
  switch (engine) {
    case Engine::kMrpt:
      return " (MRPT)";
    case Engine::kMrptDavison:
      return " (MRPT, Davison's method)";
    case Engine::kLibslam:
      break;
  }
  return "";
}

/// Keys that MRPT's class would silently ignore.
void require_mrpt_can(const Parameters& p) {
  const CalibrationParameters& c = p.calibration;
  for (const CalibrationParameter* parameter :
       {&c.scale_left, &c.scale_right, &c.track_width, &c.scale_speed, &c.scale_steering,
        &c.bias_steering, &c.scale_turn, &c.bias_turn})
    if (parameter->enabled)
      throw ConfigError(
          "engine mrpt: it cannot calibrate; enable calibration in our variants only");
  if (p.filter.linearization != "estimate" || p.filter.initial_sigma_xy > 0.0 ||
      p.filter.initial_sigma_heading_deg > 0.0)
    throw ConfigError("engine mrpt: it linearizes at the estimate and starts from a known pose");
}

Variant make_variant(const CampaignDraft& draft, const VariantDraft& description,
                     const Scenario& scenario,
                     const std::vector<std::pair<std::string, std::string>>& filter_settings) {
  Variant variant{description.name, description.engine, nominal_filter(scenario)};
  const ParameterTable table(variant.parameters);
  apply_node(table, draft.filter, draft.file);
  for (const std::string& setting : draft.filter_settings) set_parameter(table, setting);
  for (const auto& [key, value] : filter_settings) assign_parameter(table, key, value);
  load_yaml(table, description.changes, draft.file.string());
  validate(variant.parameters, {}, TruthAccess::kSimulation);
  if (variant.engine != Engine::kLibslam) require_mrpt_can(variant.parameters);
  return variant;
}

/// A value of the grid; files of a world have names that start at the campaign file.
std::string beside(const std::filesystem::path& file, const std::string& key,
                   const std::string& value) {
  const bool names_file = key.starts_with("world.") && key.ends_with("_file") && !value.empty();
  return names_file ? (file.parent_path() / value).string() : value;
}

GridPoint make_point(const CampaignDraft& draft, const Scenario& base,
                     std::vector<std::pair<std::string, std::string>> settings) {
  GridPoint point{std::move(settings), base, {}};
  std::string what;
  try {
    std::vector<std::pair<std::string, std::string>> filter_settings;
    for (const auto& [key, value] : point.settings) {
      what = key + " = " + value;
      const std::string_view target = target_of(key);
      const std::string name = key.substr(target.size());
      if (target == "scenario.")
        assign_parameter(ParameterTable(point.scenario), name, beside(draft.file, name, value));
      else
        filter_settings.emplace_back(name, value);
    }
    validate(point.scenario);
    for (const VariantDraft& variant : draft.variants) {
      what = "variant " + variant.name;
      point.variants.push_back(make_variant(draft, variant, point.scenario, filter_settings));
    }
  } catch (const ConfigError& error) {
    const std::string message = error.what();
    const std::string file = draft.file.string();
    throw ConfigError(message.starts_with(file) ? message : file + ": " + what + ": " + message);
  }
  return point;
}

void add_points(const CampaignDraft& draft, const Scenario& base, std::size_t axis,
                std::vector<std::pair<std::string, std::string>>& settings,
                std::vector<GridPoint>& points) {
  if (axis == draft.grid.size()) {
    if (points.size() >= kMostPoints)
      throw ConfigError(draft.file.string() + ": the grid has more than " +
                        std::to_string(kMostPoints) + " points");
    points.push_back(make_point(draft, base, settings));
    return;
  }
  for (const std::string& value : draft.grid[axis].values) {
    for (const std::string& key : draft.grid[axis].keys) settings.emplace_back(key, value);
    add_points(draft, base, axis + 1, settings, points);
    settings.resize(settings.size() - draft.grid[axis].keys.size());
  }
}

/// A file that is missing or broken is better found before the first run.
void check_worlds(const CampaignPlan& plan) {
  std::set<std::array<std::string, 3>> seen;
  for (const GridPoint& point : plan.points) {
    const WorldParameters& world = point.scenario.world;
    if (world.generator != "file") continue;
    if (seen.insert({world.landmarks_file, world.way_points_file, world.walls_file}).second)
      make_world(point.scenario);
  }
}

std::size_t find_reference(const CampaignPlan& plan, const std::filesystem::path& file) {
  if (plan.campaign.reference.empty()) return 0;
  const auto& variants = plan.points.front().variants;
  const auto found = std::ranges::find(variants, plan.campaign.reference, &Variant::name);
  if (found == variants.end())
    throw ConfigError(file.string() + ": campaign.reference: no variant " +
                      quote_for_message(plan.campaign.reference));
  return static_cast<std::size_t>(found - variants.begin());
}

}  // namespace

CampaignTask task_of(const CampaignPlan& plan, std::size_t index) {
  CampaignTask task;
  task.index = index;
  task.point = index / plan.runs_per_point();
  const std::size_t within = index % plan.runs_per_point();
  const auto runs = static_cast<std::size_t>(plan.campaign.runs);
  task.batch = static_cast<int>(within / runs);
  task.run = static_cast<int>(within % runs);
  task.seed = static_cast<std::uint64_t>(plan.campaign.seed) + within;
  return task;
}

CampaignPlan load_campaign(const std::filesystem::path& file,
                           const std::vector<std::string>& settings) {
  CampaignPlan plan;
  const CampaignDraft draft = read_campaign_draft(file, settings, plan.campaign);
  const Scenario base = make_scenario(draft);
  std::vector<std::pair<std::string, std::string>> chosen;
  add_points(draft, base, 0, chosen, plan.points);
  if (plan.tasks() > kMostLogs)
    throw ConfigError(file.string() + ": " + std::to_string(plan.tasks()) + " logs (points x " +
                      "batches x runs) are more than " + std::to_string(kMostLogs));
  plan.reference = find_reference(plan, file);
  check_worlds(plan);
  return plan;
}

std::string to_yaml(const CampaignPlan& plan) {
  CampaignParameters campaign = plan.campaign;
  std::string yaml = "# campaign\n" + to_yaml(ParameterTable(campaign));
  for (const GridPoint& point : plan.points) {
    Scenario scenario = point.scenario;
    yaml += "---\n# scenario of point";
    for (const auto& [key, value] : point.settings) yaml += " " + key + "=" + value;
    yaml += "\n" + to_yaml(ParameterTable(scenario));
    for (const Variant& variant : point.variants)
      yaml += "---\n# filter " + variant.name + engine_note(variant.engine) + "\n" +
              to_yaml(variant.parameters);
  }
  return yaml;
}

std::string identify(const CampaignPlan& plan) {
  CampaignPlan contents = plan;  // a world is what its files hold, wherever they stand
  std::map<std::string, std::string> digests;
  for (GridPoint& point : contents.points) {
    WorldParameters& world = point.scenario.world;
    if (world.generator != "file") continue;
    for (std::string* name : {&world.landmarks_file, &world.way_points_file, &world.walls_file}) {
      if (name->empty()) continue;
      std::string& digest = digests[*name];
      if (digest.empty()) digest = sha256_of_file(*name);
      *name = digest;
    }
  }
  return sha256_of_text(to_yaml(contents).append(version()).append(git_revision()));
}

}  // namespace libslam
