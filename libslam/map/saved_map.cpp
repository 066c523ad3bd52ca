#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include <Eigen/Cholesky>

#include <libslam/map/saved_map.hpp>

namespace libslam {
namespace {

using Eigen::Index;

constexpr Index kPlanarPose = 3, kSpatialPose = 7, kSpatialTangent = 6;
/// What rounding may take from the smallest eigenvalue of a correlation matrix: 1e-16 for each of
/// some thousand updates, with room.
constexpr double kRounding = 1e-9;

[[noreturn]] void reject(const std::string& what) {
  throw std::invalid_argument(what);
}

bool is_plain_word(const std::string& word) {
  return !word.empty() && std::none_of(word.begin(), word.end(), [](unsigned char c) {
    return c <= ' ' || c == ',' || c == '"' || c >= 127;
  });
}

void check_extent(const std::string& who, const Extent& extent) {
  for (const double number : {extent.begin, extent.end, extent.sigma_begin, extent.sigma_end})
    if (!std::isfinite(number)) reject(who + ": its extent is not finite");
  if (extent.begin > extent.end) reject(who + ": its extent ends before it begins");
  if (extent.sigma_begin < 0.0 || extent.sigma_end < 0.0)
    reject(who + ": a standard deviation of its ends is negative");
}

void check_landmark(const SavedLandmark& landmark, int dimension) {
  const std::string who = "landmark " + std::to_string(landmark.id);
  if (landmark.mean.size() != dimension)
    reject(who + " has " + std::to_string(landmark.mean.size()) + " coordinates in a map of " +
           std::to_string(dimension));
  if (!landmark.mean.allFinite()) reject(who + ": mean is not finite");
  if (!is_plain_word(landmark.type)) reject(who + ": type is not a plain word");
  if (landmark.id < 0) reject(who + ": an id is not negative");
  if (landmark.times_seen < 0 || landmark.updates < 0) reject(who + ": a count is negative");
  if (landmark.appearance && landmark.appearance->size > landmark.appearance->bytes.size())
    reject(who + ": appearance is longer than a descriptor");
  if (landmark.extent) check_extent(who, *landmark.extent);
}

void check_pose(const BlockVector& pose) {
  if (pose.size() != 0 && pose.size() != kPlanarPose && pose.size() != kSpatialPose)
    reject("a pose has 3 or 7 numbers, not " + std::to_string(pose.size()));
  if (!pose.allFinite()) reject("the pose is not finite");
  if (pose.size() == kSpatialPose && std::abs(pose.tail<4>().norm() - 1.0) > 1e-6)
    reject("the quaternion of the pose has not length 1");
}

void check_covariance(const Eigen::MatrixXd& cov) {
  if (!cov.allFinite()) reject("the covariance is not finite");
  const Eigen::VectorXd sigma = cov.diagonal().cwiseMax(0.0).cwiseSqrt();
  if ((cov.diagonal().array() < 0.0).any()) reject("a variance is negative");
  const bool factored = cov.rows() <= kLargestFactoredMap;
  Eigen::MatrixXd correlation(factored ? cov.rows() : 0, factored ? cov.rows() : 0);
  for (Index c = 0; c < cov.cols(); ++c)
    for (Index r = c; r < cov.rows(); ++r) {
      if (cov(r, c) != cov(c, r)) reject("the covariance is not symmetric");
      const double scale = sigma[r] * sigma[c];
      // What is known exactly goes with nothing else; its unit variance here only keeps the
      // factorization going.
      const double rho = scale > 0.0 ? cov(r, c) / scale : (r == c ? 1.0 : 0.0);
      if (!(std::abs(rho) <= 1.0 + kRounding) || (scale == 0.0 && cov(r, c) != 0.0))
        reject("a correlation is beyond 1: the covariance is not positive semi-definite");
      if (factored) correlation(r, c) = rho;
    }
  if (correlation.rows() == 0) return;
  correlation.diagonal().array() += kRounding * static_cast<double>(cov.rows());
  if (Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(correlation).info() != Eigen::Success)
    reject("the covariance is not positive semi-definite");
}

}  // namespace

Index SavedMap::pose_tangent() const {
  return pose.size() == kSpatialPose ? kSpatialTangent : pose.size();
}

Index SavedMap::landmark_offset() const {
  return pose_tangent() + static_cast<Index>(calibration.size());
}

Index SavedMap::tangent() const {
  const auto uncertain =
      std::count_if(landmarks.begin(), landmarks.end(), [](const auto& l) { return !l.exact; });
  return landmark_offset() + dimension * static_cast<Index>(uncertain);
}

void check_saved_map(const SavedMap& map) {
  if (map.dimension != 2 && map.dimension != 3)
    reject("landmarks have 2 or 3 coordinates, not " + std::to_string(map.dimension));
  check_pose(map.pose);
  std::set<std::string> names;
  for (const SavedCalibration& parameter : map.calibration) {
    if (!is_plain_word(parameter.name)) reject("the name of a calibration parameter is none");
    if (!std::isfinite(parameter.mean)) reject(parameter.name + " is not finite");
    if (!names.insert(parameter.name).second) reject(parameter.name + " comes twice");
  }
  for (const double value : map.excitation)
    if (!std::isfinite(value)) reject("the memory of the excitation is not finite");
  std::set<std::int64_t> ids;
  for (const SavedLandmark& landmark : map.landmarks) {
    check_landmark(landmark, map.dimension);
    if (!ids.insert(landmark.id).second)
      reject("landmark " + std::to_string(landmark.id) + " comes twice");
  }
  if (map.cov.rows() != map.tangent() || map.cov.cols() != map.tangent())
    reject("the covariance is " + std::to_string(map.cov.rows()) + " x " +
           std::to_string(map.cov.cols()) + ", expected " + std::to_string(map.tangent()) +
           " rows");
  check_covariance(map.cov);
}

SavedMap surveyed_map(const std::vector<TrueLandmark>& landmarks, double sigma) {
  SavedMap map;
  if (!landmarks.empty()) map.dimension = static_cast<int>(landmarks.front().position.size());
  for (const TrueLandmark& surveyed : landmarks) {
    if (surveyed.id == std::numeric_limits<std::int64_t>::max())
      reject("landmark " + std::to_string(surveyed.id) + " leaves no number for those after it");
    SavedLandmark& landmark = map.landmarks.emplace_back();
    landmark.id = surveyed.id;
    landmark.mean = surveyed.position;
    landmark.exact = sigma == 0.0;
    map.next_number = std::max(map.next_number, surveyed.id + 1);
  }
  map.cov = sigma * sigma * Eigen::MatrixXd::Identity(map.tangent(), map.tangent());
  check_saved_map(map);
  return map;
}

}  // namespace libslam
