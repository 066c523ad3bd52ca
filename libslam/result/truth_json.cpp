#include <libslam/result/truth_json.hpp>

namespace libslam {
namespace {

using Json = nlohmann::ordered_json;

void write_path(Json& out, const PathErrors& path) {
  out["poses"] = path.poses;
  if (path.raw) out["ate_rmse_m"] = path.raw->rmse_m;
  if (path.aligned) out["ate_rmse_aligned_m"] = path.aligned->rmse_m;
  if (path.raw) {
    out["ate_mean_m"] = path.raw->mean_m;
    out["ate_max_m"] = path.raw->max_m;
    out["rmse_x_m"] = path.raw->rmse_x_m;
    out["rmse_y_m"] = path.raw->rmse_y_m;
    if (path.raw->rmse_z_m) out["rmse_z_m"] = *path.raw->rmse_z_m;
  }
  if (path.aligned) {
    out["ate_mean_aligned_m"] = path.aligned->mean_m;
    out["ate_max_aligned_m"] = path.aligned->max_m;
    out["rmse_x_aligned_m"] = path.aligned->rmse_x_m;
    out["rmse_y_aligned_m"] = path.aligned->rmse_y_m;
    if (path.aligned->rmse_z_m) out["rmse_z_aligned_m"] = *path.aligned->rmse_z_m;
  }
  if (path.heading) {
    out["rmse_heading_rad"] = path.heading->rmse_rad;
    out["max_heading_rad"] = path.heading->max_rad;
  }
  if (path.rotation) {
    out["rmse_rotation_rad"] = path.rotation->rmse_rad;
    out["max_rotation_rad"] = path.rotation->max_rad;
  }
  if (path.drift_percent) out["drift_percent"] = *path.drift_percent;
}

void write_nees(Json& out, const NeesSummary& nees) {
  if (nees.dof != NeesSummary().dof) out["nees_dof"] = nees.dof;
  out["nees_steps"] = nees.steps;
  out["nees_mean"] = nees.mean;
  out["nees_median"] = nees.median;
  out["nees_in_95"] = nees.in_95;
  out["nees_coverage_95"] = nees.coverage_95;
  Json quarters = Json::array();
  for (const auto& mean : nees.quarter_mean) quarters.push_back(mean ? Json(*mean) : Json());
  out["nees_quarters"] = quarters;
}

void write_map(Json& out, const MapErrors& map) {
  if (map.rmse_m) out["map_rmse_m"] = *map.rmse_m;
  if (map.rmse_aligned_m) out["map_rmse_aligned_m"] = *map.rmse_aligned_m;
  out["landmarks_matched"] = map.matched;
  out["landmarks_missed"] = map.missed;
  out["landmarks_duplicate"] = map.duplicates;
}

void write_relations(Json& out, const RelationErrors& relations) {
  out = {{"trans_mean_m", relations.trans_mean_m}, {"trans_std_m", relations.trans_std_m},
         {"rot_mean_deg", relations.rot_mean_deg}, {"rot_std_deg", relations.rot_std_deg},
         {"matched", relations.matched},           {"unmatched", relations.unmatched}};
}

/// The value under `key`, or nothing; null counts as nothing.
template <typename T = double>
std::optional<T> read(const Json& in, const char* key) {
  const auto found = in.find(key);
  if (found == in.end() || found->is_null()) return std::nullopt;
  return found->template get<T>();
}

double number(const Json& in, const char* key) {
  return read(in, key).value_or(0.0);
}
int count(const Json& in, const char* key) {
  return read<int>(in, key).value_or(0);
}

PathErrors read_path(const Json& in) {
  PathErrors path;
  path.poses = count(in, "poses");
  if (const auto rmse = read(in, "ate_rmse_m"))
    path.raw = {*rmse,
                number(in, "ate_mean_m"),
                number(in, "ate_max_m"),
                number(in, "rmse_x_m"),
                number(in, "rmse_y_m"),
                read(in, "rmse_z_m")};
  if (const auto rmse = read(in, "ate_rmse_aligned_m"))
    path.aligned = {*rmse,
                    number(in, "ate_mean_aligned_m"),
                    number(in, "ate_max_aligned_m"),
                    number(in, "rmse_x_aligned_m"),
                    number(in, "rmse_y_aligned_m"),
                    read(in, "rmse_z_aligned_m")};
  if (const auto rmse = read(in, "rmse_heading_rad"))
    path.heading = {*rmse, number(in, "max_heading_rad")};
  if (const auto rmse = read(in, "rmse_rotation_rad"))
    path.rotation = {*rmse, number(in, "max_rotation_rad")};
  path.drift_percent = read(in, "drift_percent");
  return path;
}

NeesSummary read_nees(const Json& in) {
  NeesSummary nees;
  nees.dof = read<int>(in, "nees_dof").value_or(nees.dof);
  nees.steps = count(in, "nees_steps");
  nees.mean = number(in, "nees_mean");
  nees.median = number(in, "nees_median");
  nees.in_95 = number(in, "nees_in_95");
  nees.coverage_95 = number(in, "nees_coverage_95");
  if (const auto quarters = in.find("nees_quarters"); quarters != in.end())
    for (std::size_t q = 0; q < 4; ++q)
      if (const Json& mean = quarters->at(q); !mean.is_null())
        nees.quarter_mean[q] = mean.get<double>();
  return nees;
}

RelationErrors read_relations(const Json& in) {
  return {number(in, "trans_mean_m"), number(in, "trans_std_m"), number(in, "rot_mean_deg"),
          number(in, "rot_std_deg"),  count(in, "matched"),      count(in, "unmatched")};
}

}  // namespace

Json truth_to_json(const TruthComparison& truth) {
  Json out = Json::object();
  if (truth.path) write_path(out, *truth.path);
  if (truth.relative) {
    out["rpe_distance_m"] = truth.relative->distance_m;
    out["rpe_stretches"] = truth.relative->stretches;
    out["rpe_trans_percent"] = truth.relative->trans_percent;
    out["rpe_rot_deg_per_m"] = truth.relative->rot_deg_per_m;
  }
  if (truth.nees) write_nees(out, *truth.nees);
  if (truth.map) write_map(out, *truth.map);
  if (truth.relations) write_relations(out["relations"], *truth.relations);
  if (truth.path_smoothed) write_path(out["path_smoothed"], *truth.path_smoothed);
  if (truth.relations_smoothed)
    write_relations(out["relations_smoothed"], *truth.relations_smoothed);
  for (const auto& [name, error] : truth.calibration_error) out["calibration_error"][name] = error;
  return out;
}

TruthComparison truth_from_json(const Json& object) {
  TruthComparison truth;
  if (object.contains("poses")) truth.path = read_path(object);
  if (object.contains("rpe_distance_m"))
    truth.relative = {number(object, "rpe_distance_m"), count(object, "rpe_stretches"),
                      number(object, "rpe_trans_percent"), number(object, "rpe_rot_deg_per_m")};
  if (object.contains("nees_mean")) truth.nees = read_nees(object);
  if (object.contains("landmarks_matched")) {
    truth.map.emplace();
    truth.map->matched = count(object, "landmarks_matched");
    truth.map->missed = count(object, "landmarks_missed");
    truth.map->duplicates = count(object, "landmarks_duplicate");
    truth.map->rmse_m = read(object, "map_rmse_m");
    truth.map->rmse_aligned_m = read(object, "map_rmse_aligned_m");
  }
  if (const auto path = object.find("path_smoothed"); path != object.end())
    truth.path_smoothed = read_path(*path);
  if (const auto relations = object.find("relations"); relations != object.end())
    truth.relations = read_relations(*relations);
  if (const auto relations = object.find("relations_smoothed"); relations != object.end())
    truth.relations_smoothed = read_relations(*relations);
  if (const auto errors = object.find("calibration_error"); errors != object.end())
    errors->get_to(truth.calibration_error);
  return truth;
}

}  // namespace libslam
