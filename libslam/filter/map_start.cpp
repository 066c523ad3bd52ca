#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include <libslam/filter/map_start.hpp>

namespace libslam {

namespace {

using Eigen::Index;

constexpr Index kOutside = -1;
constexpr const char* kPoint = "point";

[[noreturn]] void reject(const std::string& what) {
  throw std::invalid_argument("the map does not fit the configuration: " + what);
}

/// For every coordinate of the state the row of the map's covariance that describes it, or
/// `kOutside`.
using Rows = std::vector<Index>;

void append_rows(Rows& rows, Index first, Index count) {
  for (Index i = 0; i < count; ++i) rows.push_back(first == kOutside ? kOutside : first + i);
}

void require_fit(const MapStart& start, const MapBlocks& blocks, const GaussianState& state) {
  const SavedMap& map = *start.map;
  if (map.dimension != storage_dimension(blocks.landmark))
    reject("its landmarks have " + std::to_string(map.dimension) +
           " coordinates, those of the measurement model " +
           std::to_string(storage_dimension(blocks.landmark)));
  for (const SavedLandmark& landmark : map.landmarks)
    if (landmark.type != kPoint)
      reject("landmark " + std::to_string(landmark.id) + " is of type " + landmark.type);
  const Index pose_size = state.estimate(blocks.pose).size();
  if (start.pose && start.pose->size() != pose_size)
    throw std::invalid_argument("the start pose has " + std::to_string(start.pose->size()) +
                                " numbers, the pose of the filter " + std::to_string(pose_size));
  if (!start.pose && map.pose.size() == 0)
    reject("it has no pose to start at; set map.start to given_pose, and map.initial_x, ...");
  if (!start.pose && map.pose.size() != pose_size)
    reject("its last pose has " + std::to_string(map.pose.size()) + " numbers, that of the filter " +
           std::to_string(pose_size));
}

/// Estimates of pose and calibration; returns the rows of the map that describe them.
Rows enter_robot(const MapStart& start, const MapBlocks& blocks, GaussianState& state) {
  const SavedMap& map = *start.map;
  Rows rows;
  state.set_estimate(blocks.pose, start.pose ? *start.pose : map.pose);
  append_rows(rows, start.pose ? kOutside : 0, state.size(blocks.pose));
  for (const BlockId block : blocks.calibration) {
    const auto saved = std::find_if(
        map.calibration.begin(), map.calibration.end(),
        [&](const SavedCalibration& parameter) { return parameter.name == state.spec(block).name; });
    const bool taken = start.saved_calibration && saved != map.calibration.end();
    if (taken) state.set_estimate(block, Eigen::VectorXd::Constant(1, saved->mean));
    append_rows(rows, taken ? map.pose_tangent() + (saved - map.calibration.begin()) : kOutside, 1);
  }
  return rows;
}

void enter_landmarks(const MapStart& start, const BlockSpec& spec, GaussianState& state,
                     LandmarkRegistry& registry, Rows& rows) {
  const SavedMap& map = *start.map;
  const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(map.dimension, map.dimension);
  Index row = map.landmark_offset();
  for (const SavedLandmark& landmark : map.landmarks) {
    const Index own = row;
    if (!landmark.exact) row += map.dimension;
    if (start.landmarks_given && !landmark.confirmed) continue;
    const BlockId block = landmark.exact ? state.add_constant(spec, landmark.mean)
                                         : state.add(spec, landmark.mean, nothing);
    if (!landmark.exact) append_rows(rows, own, map.dimension);
    registry.restore(
        {block, landmark.id, landmark.times_seen, landmark.updates, landmark.confirmed});
  }
  registry.number_from(map.next_number);
}

bool same_parameters(const SavedMap& map, const MapBlocks& blocks, const GaussianState& state) {
  return std::equal(map.calibration.begin(), map.calibration.end(), blocks.calibration.begin(),
                    blocks.calibration.end(), [&](const SavedCalibration& saved, BlockId block) {
                      return saved.name == state.spec(block).name;
                    });
}

}  // namespace

void enter_map(const MapStart& start, const MapBlocks& blocks, GaussianState& state,
               LandmarkRegistry& registry, Excitation& excitation) {
  require_fit(start, blocks, state);
  const SavedMap& map = *start.map;
  state.reserve(state.dimension() + map.tangent());
  Rows rows = enter_robot(start, blocks, state);
  enter_landmarks(start, blocks.landmark, state, registry, rows);
  Eigen::MatrixXd cov = state.full_covariance();
  for (Index c = 0; c < cov.cols(); ++c)
    for (Index r = 0; r < cov.rows(); ++r) {
      const Index row = rows[static_cast<std::size_t>(r)], col = rows[static_cast<std::size_t>(c)];
      if (row != kOutside && col != kOutside) cov(r, c) = map.cov(row, col);
    }
  state.covariance().assign(cov);
  if (!start.pose && start.saved_calibration && !map.excitation.empty() &&
      same_parameters(map, blocks, state))
    excitation.remember(map.excitation);
}

SavedMap leave_map(const MapBlocks& blocks, const GaussianState& state,
                   const LandmarkRegistry& registry, const Excitation& excitation) {
  SavedMap map;
  map.dimension = storage_dimension(blocks.landmark);
  map.pose = state.estimate(blocks.pose);
  std::vector<BlockId> order{blocks.pose};
  for (const BlockId block : blocks.calibration) {
    map.calibration.push_back({state.spec(block).name, state.estimate(block)[0]});
    order.push_back(block);
  }
  if (!map.calibration.empty()) map.excitation = excitation.memory();
  map.next_number = registry.next_number();
  for (const RegisteredLandmark& landmark : registry.landmarks()) {
    const bool exact = state.is_constant(landmark.block);
    map.landmarks.push_back({landmark.id, kPoint, state.estimate(landmark.block),
                             landmark.times_seen, landmark.updates, landmark.confirmed, exact,
                             nullptr});
    if (!exact) order.push_back(landmark.block);
  }
  Rows rows;
  for (const BlockId block : order) append_rows(rows, state.offset(block), state.size(block));
  map.cov = state.full_covariance()(rows, rows);
  return map;
}

}  // namespace libslam
