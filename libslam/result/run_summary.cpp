#include <fstream>
#include <iterator>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include <libslam/result/run_summary.hpp>
#include <libslam/result/truth_json.hpp>

namespace libslam {
namespace {

using Json = nlohmann::ordered_json;

/// Writes every present member of a summary under its key.
class Writer {
 public:
  explicit Writer(Json& object) : object_(object) {}
  void operator()(const char* key, const auto& value) const { object_[key] = value; }
  template <typename T>
  void operator()(const char* key, const std::optional<T>& value) const {
    if (value) object_[key] = *value;
  }
  void section(const char* key, auto&& visit) const {
    Json child = Json::object();
    visit(Writer(child));
    if (!child.empty()) object_[key] = std::move(child);
  }

 private:
  Json& object_;
};

/// Reads every present key into its member.
class Reader {
 public:
  explicit Reader(const Json& object) : object_(object) {}
  template <typename T>
  void operator()(const char* key, T& value) const {
    if (const auto found = object_.find(key); found != object_.end() && !found->is_null())
      found->get_to(value);
  }
  template <typename T>
  void operator()(const char* key, std::optional<T>& value) const {
    if (const auto found = object_.find(key); found != object_.end() && !found->is_null())
      value = found->get<T>();
  }
  void section(const char* key, auto&& visit) const {
    const auto found = object_.find(key);
    if (found == object_.end()) return;
    found->get_ref<const Json::object_t&>();  // throws where it is not an object
    visit(Reader(*found));
  }

 private:
  const Json& object_;
};

/// The one description of run.json that both directions share. `summary` is const when writing.
void visit_keys(const auto& v, auto& summary) {
  v("program", summary.program);
  v("version", summary.version);
  v("git", summary.git);
  v("config_sha256", summary.config_sha256);
  v("input_sha256", summary.input_sha256);
  v("seed", summary.seed);
  v("threads", summary.threads);
  v("exit_code", summary.exit_code);
  v("status", summary.status);
  v.section("input", [&](const auto& s) {
    s("file", summary.input.file);
    s("entries", summary.input.entries);
    s("actions", summary.input.actions);
    s("observations", summary.input.observations);
    s("duration_s", summary.input.duration_s);
    s("skipped", summary.input.skipped);
    s("repaired", summary.input.repaired);
    s("warnings", summary.input.warnings);
    s.section("map", [&](const auto& map) {
      map("file", summary.input.map_file);
      map("sha256", summary.input.map_sha256);
    });
  });
}

void visit_timing(const auto& v, auto& timing, auto& step_ms) {
  v("wall_s", timing.wall_s);
  v("cpu_s", timing.cpu_s);
  v("steps", timing.steps);
  if (step_ms)
    v.section("step_ms", [&](const auto& s) {
      s("mean", step_ms->mean);
      s("p50", step_ms->p50);
      s("p95", step_ms->p95);
      s("max", step_ms->max);
    });
  v("phases", timing.phases);
  v("peak_rss_mb", timing.peak_rss_mb);
  v("realtime_factor", timing.realtime_factor);
  v("updates", timing.updates);
  v("updates_without_stretch", timing.updates_without_stretch);
  v("saved_s", timing.saved_s);
}

void visit_health(const auto& v, auto& health) {
  v("nis_mean", health.nis_mean);
  v("nis_in_95", health.nis_in_95);
  v("gated_fraction", health.gated_fraction);
  v("min_eigenvalue", health.min_eigenvalue);
  v("disturbances", health.disturbances);
  v("resamplings", health.resamplings);
  v("injected", health.injected);
  v("ess_min", health.ess_min);
  v("features", health.features);
}

Json result_to_json(const RunSummary::Result& result) {
  Json object = Json::object();
  if (result.pose) object["pose"] = {result.pose->x(), result.pose->y(), result.pose->z()};
  if (result.pose3d) {
    const auto& p = result.pose3d->position;
    const auto& q = result.pose3d->rotation;
    object["pose3d"] = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
  }
  if (result.placement == Placement::none) object["placement"] = "none";
  object["landmarks"] = result.landmarks;
  for (const CalibrationValue& value : result.calibration)
    object["calibration"][value.name] = {
        {"mean", value.mean}, {"sigma", value.sigma}, {"observable", value.observable}};
  for (const AdaptedNoise& noise : result.noise)
    object["noise"][noise.name] = {{"sigma", noise.sigma}, {"configured", noise.configured}};
  return object;
}

void read_poses(const Json& object, RunSummary::Result& result) {
  if (const auto pose = object.find("pose"); pose != object.end()) {
    const auto numbers = pose->get<std::array<double, 3>>();
    result.pose.emplace(numbers[0], numbers[1], numbers[2]);
  }
  if (const auto pose = object.find("pose3d"); pose != object.end()) {
    const auto n = pose->get<std::array<double, 7>>();
    result.pose3d = {{n[0], n[1], n[2]}, {n[6], n[3], n[4], n[5]}};
  }
  if (object.value("placement", "first") == "none") result.placement = Placement::none;
}

RunSummary::Result result_from_json(const Json& object) {
  RunSummary::Result result;
  read_poses(object, result);
  result.landmarks = object.value("landmarks", std::int64_t{0});
  if (const auto calibration = object.find("calibration"); calibration != object.end())
    for (const auto& [name, value] : calibration->items()) {
      CalibrationValue& entry = result.calibration.emplace_back();
      entry.name = name;
      value.at("mean").get_to(entry.mean);
      value.at("sigma").get_to(entry.sigma);
      value.at("observable").get_to(entry.observable);
    }
  if (const auto noises = object.find("noise"); noises != object.end())
    for (const auto& [name, value] : noises->items())
      result.noise.push_back(
          {name, value.at("sigma").get<double>(), value.at("configured").get<double>()});
  return result;
}

Json events_to_json(const std::vector<RunEvent>& events) {
  Json list = Json::array();
  for (const RunEvent& event : events)
    list.push_back({{"time", event.time}, {"step", event.step}, {"what", event.what}});
  return list;
}

std::vector<RunEvent> events_from_json(const Json& list) {
  std::vector<RunEvent> events;
  for (const Json& event : list)
    events.push_back({event.at("time").get<double>(), event.at("step").get<std::int64_t>(),
                      event.at("what").get<std::string>()});
  return events;
}

}  // namespace

std::string to_json_text(const RunSummary& summary) {
  Json object = Json::object();
  const Writer writer(object);
  visit_keys(writer, summary);
  object["result"] = result_to_json(summary.result);
  writer.section("timing",
                 [&](const Writer& s) { visit_timing(s, summary.timing, summary.timing.step_ms); });
  if (summary.timing.phases.empty()) object["timing"].erase("phases");
  writer.section("health", [&](const Writer& s) { visit_health(s, summary.health); });
  if (summary.health.features.empty()) object["health"].erase("features");
  if (object["health"].empty()) object.erase("health");
  if (!summary.health.events.empty())
    object["health"]["events"] = events_to_json(summary.health.events);
  if (summary.truth)
    if (Json truth = truth_to_json(*summary.truth); !truth.empty()) object["truth"] = truth;
  // Warnings may quote bytes of an untrusted log: replace what is not UTF-8.
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunSummary parse_run_summary(const std::string& text, const std::string& name) {
  try {
    const Json object = Json::parse(text);
    if (!object.is_object()) throw std::runtime_error(name + ": not a JSON object");
    RunSummary summary;
    const Reader reader(object);
    visit_keys(reader, summary);
    if (object.contains("result")) summary.result = result_from_json(object["result"]);
    reader.section("timing", [&](const Reader& s) {
      std::optional<StepTime> step_ms;
      if (object["timing"].contains("step_ms")) step_ms.emplace();
      visit_timing(s, summary.timing, step_ms);
      summary.timing.step_ms = step_ms;
    });
    reader.section("health", [&](const Reader& s) { visit_health(s, summary.health); });
    if (object.contains("health") && object["health"].contains("events"))
      summary.health.events = events_from_json(object["health"]["events"]);
    if (object.contains("truth")) summary.truth = truth_from_json(object["truth"]);
    return summary;
  } catch (const Json::exception& error) {
    throw std::runtime_error(name + ": " + error.what());
  }
}

RunSummary read_run_summary(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot open " + file.string());
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return parse_run_summary(text, file.string());
}

}  // namespace libslam
