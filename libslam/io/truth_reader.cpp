#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include <nlohmann/json.hpp>

#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>
#include <libslam/io/text_reader.hpp>
#include <libslam/io/truth_reader.hpp>

namespace libslam {
namespace {

constexpr std::size_t kTumColumns = 8, kMrptPathColumns = 6, kMrptLandmarkColumns = 7,
                      kRelationColumns = 8;

double yaw_of_quaternion(double x, double y, double z, double w) {
  return std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
}

/// Finer than the nine decimals of a TUM file can tell.
constexpr double kLevel = 1e-9;

/// Whether a path leaves the plane z = 0 or the robot ever rolls or pitches.
bool leaves_the_plane(const std::vector<SpatialPose>& path) {
  return std::any_of(path.begin(), path.end(), [](const SpatialPose& pose) {
    return std::abs(pose.position.z()) > kLevel || std::abs(pose.rotation.x()) > kLevel ||
           std::abs(pose.rotation.y()) > kLevel;
  });
}

Eigen::Quaterniond rotation_of(double yaw, double pitch, double roll) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

void read_tum_row(const TextReader& row, Trajectory& path) {
  const double time = row.number(0);
  if (!path.times.empty() && time < path.times.back()) row.reject("time goes backwards");
  Eigen::Vector4d q(row.number(4), row.number(5), row.number(6), row.number(7));
  if (!(q.norm() > 1e-6)) row.reject("the quaternion is zero");
  q.normalize();
  path.times.push_back(time);
  path.poses.emplace_back(row.number(1), row.number(2),
                          yaw_of_quaternion(q.x(), q.y(), q.z(), q.w()));
  path.spatial.push_back({{row.number(1), row.number(2), row.number(3)}, Eigen::Quaterniond(q)});
}

void read_mrpt_row(const TextReader& row, Trajectory& path) {
  path.poses.emplace_back(row.number(0), row.number(1), row.number(3));
  path.spatial.push_back({{row.number(0), row.number(1), row.number(2)},
                          rotation_of(row.number(3), row.number(4), row.number(5))});
}

TrueLandmark read_landmark_row(const TextReader& row) {
  TrueLandmark landmark;
  if (row.columns() == kMrptLandmarkColumns) {
    landmark.id = row.integer(6);
    landmark.position = Eigen::Vector3d(row.number(0), row.number(1), row.number(2));
    return landmark;
  }
  landmark.id = row.integer(0);
  landmark.position.resize(static_cast<Eigen::Index>(row.columns()) - 1);
  for (Eigen::Index i = 0; i < landmark.position.size(); ++i)
    landmark.position[i] = row.number(static_cast<std::size_t>(i) + 1);
  return landmark;
}

/// Half of the resolution that log files print times with [s].
constexpr double kPrintedTime = 5e-7;

/// `time` of the source as the rawlog has it.
void follow_mended_clock(const std::map<double, double>& mended_times, double& time) {
  const auto mended = mended_times.lower_bound(time - kPrintedTime);
  if (mended != mended_times.end() && mended->first < time + kPrintedTime) time = mended->second;
}

}  // namespace

Trajectory read_true_path(const std::string& file) {
  TextReader row(file);
  Trajectory path;
  std::size_t columns = 0;
  while (row.next()) {
    if (columns == 0) columns = row.columns();
    if (columns != kTumColumns && columns != kMrptPathColumns)
      row.reject("a path has 8 (TUM) or 6 (x y z yaw pitch roll) columns, not " +
                 std::to_string(columns));
    if (row.columns() != columns) row.reject("the number of columns changes");
    if (columns == kTumColumns)
      read_tum_row(row, path);
    else
      read_mrpt_row(row, path);
  }
  if (path.poses.empty()) throw InputError(file + ": holds no poses");
  if (!leaves_the_plane(path.spatial)) path.spatial = {};
  return path;
}

std::vector<TrueLandmark> read_true_landmarks(const std::string& file) {
  TextReader row(file);
  std::vector<TrueLandmark> landmarks;
  std::set<std::int64_t> known;
  while (row.next()) {
    const std::size_t columns = row.columns();
    if (columns != 3 && columns != 4 && columns != kMrptLandmarkColumns)
      row.reject("a landmark has 3 or 4 (id,x,y[,z]) or 7 (x y z . . . id) columns, not " +
                 std::to_string(columns));
    if (landmarks.empty() && row.word(0) == "id") continue;
    landmarks.push_back(read_landmark_row(row));
    if (!known.insert(landmarks.back().id).second)
      row.reject("landmark " + std::to_string(landmarks.back().id) + " comes twice");
  }
  if (landmarks.empty()) throw InputError(file + ": holds no landmarks");
  return landmarks;
}

std::vector<PoseRelation> read_relations(const std::string& file) {
  TextReader row(file);
  std::vector<PoseRelation> relations;
  while (row.next()) {
    if (row.columns() != kRelationColumns)
      row.reject("a relation has 8 columns (t1 t2 x y z roll pitch yaw), not " +
                 std::to_string(row.columns()));
    for (const std::size_t out_of_plane : {4U, 5U, 6U})
      if (std::abs(row.number(out_of_plane)) > kLevel)
        row.reject("the relation leaves the plane: z, roll and pitch must be 0");
    relations.push_back(
        {row.number(0), row.number(1), {row.number(2), row.number(3), row.number(7)}});
  }
  if (relations.empty()) throw InputError(file + ": holds no relations");
  return relations;
}

TruthNotes read_truth_notes(const std::string& file) {
  require_input_file(file);
  TruthNotes notes;
  try {
    std::ifstream in(file);
    const auto json = nlohmann::json::parse(in);
    if (!json.is_object()) throw InputError(file + ": is not a JSON object");
    notes.has_heading = json.value("has_heading", true);
    const auto point = json.value("point_on_robot", std::array<double, 2>{0.0, 0.0});
    notes.point_on_robot = {point[0], point[1]};
    const auto calibration = json.value("calibration", nlohmann::json::object());
    for (const auto& [name, value] : calibration.items())
      notes.calibration[name] = value.get<double>();
    for (const auto& pair : json.value("mended_times", nlohmann::json::array()))
      notes.mended_times[pair.at(0).get<double>()] = pair.at(1).get<double>();
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file + ": " + error.what());
  }
  return notes;
}

TruthFiles find_truth(const std::string& rawlog) {
  const std::filesystem::path stem = std::filesystem::path(rawlog).replace_extension();
  const auto beside = [&](std::initializer_list<const char*> endings) -> std::string {
    for (const char* ending : endings) {
      std::error_code error;
      const std::string name = stem.string() + ending;
      if (std::filesystem::is_regular_file(name, error)) return name;
    }
    return {};
  };
  return {beside({".truth.tum", "_ground_truth_robot_path.txt"}),
          beside({".landmarks.csv", "_ground_truth.txt"}), beside({".truth.json"}), true,
          beside({".relations"})};
}

GroundTruth read_truth(const TruthFiles& files) {
  GroundTruth truth;
  if (!files.path.empty()) truth.path = read_true_path(files.path);
  if (!files.landmarks.empty()) truth.landmarks = read_true_landmarks(files.landmarks);
  if (!files.relations.empty()) truth.relations = read_relations(files.relations);
  if (!files.notes.empty()) {
    TruthNotes notes = read_truth_notes(files.notes);
    for (PoseRelation& relation : truth.relations) {
      follow_mended_clock(notes.mended_times, relation.from_time);
      follow_mended_clock(notes.mended_times, relation.to_time);
    }
    truth.calibration = std::move(notes.calibration);
    if (!files.notes_describe_path) return truth;
    truth.path.has_heading = notes.has_heading;
    truth.path.point_on_robot = notes.point_on_robot;
    if (!notes.has_heading)
      for (auto& pose : truth.path.poses) pose.z() = 0.0;
  }
  return truth;
}

}  // namespace libslam
