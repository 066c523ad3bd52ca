#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Cholesky>

#include <libslam/batch/batch_comparison.hpp>
#include <libslam/result/alignment.hpp>
#include <libslam/result/truth_json.hpp>
#include <libslam/state/block.hpp>

namespace libslam {

namespace {

using Json = nlohmann::ordered_json;

BatchAnswer filter_answer(const FilterReplay& replay) {
  return {replay.path, replay.map, replay.calibration, std::nullopt};
}

BatchAnswer batch_answer(const FilterReplay& replay, const BatchResult& batch) {
  BatchAnswer answer;
  for (std::size_t k = 0; k < replay.path.size(); ++k)
    answer.path.push_back({replay.path[k].step, replay.path[k].time, batch.estimate.path[k],
                           Eigen::Matrix3d::Zero()});
  std::map<std::int64_t, std::size_t> position;
  for (std::size_t i = 0; i < replay.log.landmarks.size(); ++i)
    position[replay.log.landmarks[i]] = i;
  for (LandmarkEstimate landmark : replay.map) {
    landmark.mean = batch.estimate.landmarks[position.at(landmark.id)];
    landmark.cov.setZero();
    answer.map.add(std::move(landmark));
  }
  for (std::size_t i = 0; i < replay.calibration.size(); ++i) {
    CalibrationValue& value = answer.calibration.emplace_back(replay.calibration[i]);
    const auto row = static_cast<Eigen::Index>(i);
    value.mean = batch.estimate.calibration[row];
    value.sigma = row < batch.sigma_calibration.size() ? batch.sigma_calibration[row]
                                                       : std::numeric_limits<double>::quiet_NaN();
  }
  return answer;
}

double rmse(const Eigen::MatrixXd& columns) {
  return std::sqrt(columns.colwise().squaredNorm().mean());
}

void measure_landmarks(const LandmarkMap& filter, const LandmarkMap& batch, BatchDistance& out) {
  out.landmarks = static_cast<int>(filter.size());
  if (filter.empty()) return;
  const Eigen::Index size = filter.begin()->mean.size();
  Eigen::MatrixXd ours(size, static_cast<Eigen::Index>(filter.size())), best = ours;
  double normalized = 0.0;
  for (Eigen::Index i = 0; i < ours.cols(); ++i) {
    const LandmarkEstimate& landmark = filter.landmarks()[static_cast<std::size_t>(i)];
    ours.col(i) = landmark.mean;
    best.col(i) = batch.landmarks()[static_cast<std::size_t>(i)].mean;
    const Eigen::VectorXd d = ours.col(i) - best.col(i);
    normalized += d.dot(landmark.cov.ldlt().solve(d)) / static_cast<double>(size);
  }
  const Eigen::MatrixXd difference = ours - best;
  out.landmarks_rmse_m = rmse(difference);
  out.landmarks_max_m = difference.colwise().norm().maxCoeff();
  out.landmarks_normalized = normalized / static_cast<double>(ours.cols());
  if (size != 2) return;
  if (const auto T_batch_filter = fit_rigid(ours, best)) {
    for (Eigen::Index i = 0; i < ours.cols(); ++i)
      ours.col(i).head<2>() = transform_point(*T_batch_filter, ours.col(i));
    out.landmarks_rmse_aligned_m = rmse(ours - best);
  }
}

void measure_path(const std::vector<EstimatedPose>& filter, const std::vector<EstimatedPose>& batch,
                  BatchDistance& out) {
  if (filter.empty()) return;
  double squares = 0.0, heading_squares = 0.0;
  for (std::size_t k = 0; k < filter.size(); ++k) {
    const Eigen::Vector3d d = filter[k].pose - batch[k].pose;
    out.end_m = d.head<2>().norm();
    out.end_heading_rad = std::abs(wrap_angle(d[2]));
    out.path_max_m = std::max(out.path_max_m, out.end_m);
    squares += out.end_m * out.end_m;
    heading_squares += out.end_heading_rad * out.end_heading_rad;
  }
  const auto count = static_cast<double>(filter.size());
  out.path_rmse_m = std::sqrt(squares / count);
  out.path_rmse_heading_rad = std::sqrt(heading_squares / count);
}

Json answer_to_json(const BatchAnswer& answer) {
  Json out = Json::object();
  for (const CalibrationValue& value : answer.calibration) {
    out["calibration"][value.name]["mean"] = value.mean;
    if (std::isfinite(value.sigma)) out["calibration"][value.name]["sigma"] = value.sigma;
  }
  if (answer.truth) out["truth"] = truth_to_json(*answer.truth);
  return out;
}

Json distance_to_json(const BatchDistance& distance) {
  Json out = {{"landmarks", distance.landmarks}};
  const auto write = [&](const char* key, const std::optional<double>& value) {
    if (value) out[key] = *value;
  };
  write("landmarks_rmse_m", distance.landmarks_rmse_m);
  write("landmarks_rmse_aligned_m", distance.landmarks_rmse_aligned_m);
  write("landmarks_max_m", distance.landmarks_max_m);
  write("landmarks_normalized", distance.landmarks_normalized);
  write("path_rmse_m", distance.path_rmse_m);
  write("path_max_m", distance.path_max_m);
  write("path_rmse_heading_rad", distance.path_rmse_heading_rad);
  write("end_m", distance.end_m);
  write("end_heading_rad", distance.end_heading_rad);
  return out;
}

Json on_line_to_json(const OnLineComparison& on_line) {
  Json out = {{"poses", on_line.poses},
              {"distance_rmse_m", on_line.distance_rmse_m},
              {"distance_rmse_heading_rad", on_line.distance_rmse_heading_rad}};
  if (on_line.distance_normalized) out["distance_normalized"] = *on_line.distance_normalized;
  const auto write = [&](const char* key, const std::optional<PathErrors>& path) {
    if (!path) return;
    TruthComparison truth;
    truth.path = path;
    out[key] = truth_to_json(truth);
  };
  write("filter", on_line.filter);
  write("batch", on_line.batch);
  return out;
}

}  // namespace

BatchComparison compare_with_batch(const FilterReplay& replay, const BatchResult& batch,
                                   const GroundTruth& truth, LandmarkIdentity identity) {
  BatchComparison comparison{
      filter_answer(replay), batch_answer(replay, batch), {}, batch, std::nullopt};
  measure_landmarks(comparison.filter.map, comparison.batch.map, comparison.distance);
  measure_path(comparison.filter.path, comparison.batch.path, comparison.distance);
  if (!truth.empty())
    for (BatchAnswer* answer : {&comparison.filter, &comparison.batch})
      answer->truth = compare_with_truth(answer->path, answer->map,
                                         calibration_means(answer->calibration), truth, identity);
  return comparison;
}

OnLineComparison compare_on_line(const FilterReplay& replay, const EkfSlamParts& parts,
                                 const BatchResult& batch, const GroundTruth& truth, int count) {
  // The first step places both on the truth.
  std::vector<std::size_t> steps = {0};
  for (int i = 1; i <= count && replay.path.size() > 1; ++i)
    steps.push_back((replay.path.size() - 1) * static_cast<std::size_t>(i) /
                    static_cast<std::size_t>(count));
  const std::vector<Eigen::Vector3d> best =
      optimize_on_line(replay.log, parts, batch.estimate, steps);
  OnLineComparison comparison;
  comparison.poses = static_cast<int>(steps.size()) - 1;
  std::vector<EstimatedPose> ours, theirs;
  double squares = 0.0, heading_squares = 0.0, normalized = 0.0;
  int regular = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const EstimatedPose& pose = ours.emplace_back(replay.path[steps[i]]);
    theirs.push_back({pose.step, pose.time, best[i], Eigen::Matrix3d::Zero()});
    Eigen::Vector3d d = pose.pose - best[i];
    d[2] = wrap_angle(d[2]);
    squares += d.head<2>().squaredNorm();
    heading_squares += d[2] * d[2];
    const Eigen::LLT<Eigen::Matrix3d> cov(pose.cov);
    if (i == 0 || cov.info() != Eigen::Success) continue;
    normalized += d.dot(cov.solve(d)) / 3.0;
    ++regular;
  }
  comparison.distance_rmse_m = std::sqrt(squares / std::max(1, comparison.poses));
  comparison.distance_rmse_heading_rad = std::sqrt(heading_squares / std::max(1, comparison.poses));
  if (regular > 0) comparison.distance_normalized = normalized / regular;
  comparison.filter = compare_with_truth(ours, {}, {}, truth, LandmarkIdentity::known).path;
  comparison.batch = compare_with_truth(theirs, {}, {}, truth, LandmarkIdentity::known).path;
  return comparison;
}

Json to_json(const BatchComparison& comparison) {
  const BatchResult& solved = comparison.optimization;
  Json out = {{"filter", answer_to_json(comparison.filter)},
              {"batch", answer_to_json(comparison.batch)},
              {"distance", distance_to_json(comparison.distance)},
              {"optimization",
               {{"chi_square_before", solved.chi_square_before},
                {"chi_square", solved.chi_square},
                {"degrees_of_freedom", solved.degrees_of_freedom},
                {"poses", solved.poses},
                {"iterations", solved.iterations},
                {"converged", solved.converged}}}};
  if (comparison.on_line) out["on_line"] = on_line_to_json(*comparison.on_line);
  return out;
}

}  // namespace libslam
