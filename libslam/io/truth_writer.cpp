#include <algorithm>
#include <filesystem>

#include <libslam/io/truth_writer.hpp>
#include <libslam/map/csv_text.hpp>
#include <libslam/result/atomic_file.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {

namespace {

std::string stem_of(const std::string& rawlog) {
  return std::filesystem::path(rawlog).replace_extension().string();
}

}  // namespace

std::string landmarks_text(const std::vector<TrueLandmark>& landmarks) {
  const bool spatial = std::ranges::any_of(
      landmarks, [](const TrueLandmark& landmark) { return landmark.position.size() > 2; });
  std::string text = spatial ? "id,x,y,z\n" : "id,x,y\n";
  for (const TrueLandmark& landmark : landmarks) {
    append_number(text, landmark.id);
    for (const double coordinate : landmark.position) {
      text += ',';
      append_number(text, coordinate);
    }
    text += '\n';
  }
  return text;
}

std::string relations_text(const std::vector<PoseRelation>& relations) {
  std::string text;
  for (const PoseRelation& relation : relations) {
    const Eigen::Vector3d& pose = relation.T_from_to;
    append_number(text, relation.from_time);
    for (const double value : {relation.to_time, pose.x(), pose.y(), 0.0, 0.0, 0.0, pose.z()}) {
      text += ' ';
      append_number(text, value);
    }
    text += '\n';
  }
  return text;
}

void remove_truth_beside(const std::string& rawlog) {
  std::error_code ignored;
  for (const char* const ending : {".truth.tum", ".landmarks.csv", ".relations"})
    std::filesystem::remove(stem_of(rawlog) + ending, ignored);
}

void write_truth_beside(const std::string& rawlog, const GroundTruth& truth,
                        const std::string& notes) {
  const std::string path = tum_text(truth.path);
  if (!path.empty()) replace_file(stem_of(rawlog) + ".truth.tum", path);
  if (!truth.landmarks.empty())
    replace_file(stem_of(rawlog) + ".landmarks.csv", landmarks_text(truth.landmarks));
  if (!truth.relations.empty())
    replace_file(stem_of(rawlog) + ".relations", relations_text(truth.relations));
  replace_file(stem_of(rawlog) + ".truth.json", notes);
}

}  // namespace libslam
