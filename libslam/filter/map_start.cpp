#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include <libslam/filter/map_start.hpp>

namespace libslam {

namespace {

using Eigen::Index;

constexpr Index kOutside = -1;

/// What a map calls such a landmark.
const char* type_of(const BlockSpec& landmark) {
  return landmark.role == WorldRole::kLine ? "line" : "point";
}

[[noreturn]] void reject(const std::string& what) {
  throw std::invalid_argument("the map does not fit the configuration: " + what);
}

/// For every coordinate of the state the row of the map's covariance that describes it, or
/// `kOutside`.
using Rows = std::vector<Index>;

void append_rows(Rows& rows, Index first, Index count) {
  for (Index i = 0; i < count; ++i) rows.push_back(first == kOutside ? kOutside : first + i);
}

void require_fit(const MapStart& start, const MappedParts& parts) {
  const SavedMap& map = *start.map;
  const int dimension = storage_dimension(parts.landmark);
  if (map.dimension != dimension)
    reject("its landmarks have " + std::to_string(map.dimension) +
           " coordinates, those of the measurement model " + std::to_string(dimension));
  for (const SavedLandmark& landmark : map.landmarks)
    if (landmark.type != type_of(parts.landmark))
      reject("landmark " + std::to_string(landmark.id) + " is of type " + landmark.type +
             ", those of the measurement model are of type " + type_of(parts.landmark));
  if (!start.at_saved_pose) return;
  if (map.pose.size() == 0)
    reject("it has no pose to start at; set map.start to given_pose, and map.initial_x, ...");
  const Index size = parts.state.estimate(parts.pose).size();
  if (map.pose.size() != size)
    reject("its last pose has " + std::to_string(map.pose.size()) +
           " numbers, that of the filter " + std::to_string(size));
}

/// Estimates of pose and calibration; returns the rows of the map that describe them.
Rows enter_robot(const MapStart& start, const MappedParts& parts) {
  const SavedMap& map = *start.map;
  GaussianState& state = parts.state;
  Rows rows;
  if (start.at_saved_pose) state.set_estimate(parts.pose, map.pose);
  append_rows(rows, start.at_saved_pose ? 0 : kOutside, state.size(parts.pose));
  for (const BlockId block : parts.calibration.blocks()) {
    const auto saved = std::find_if(map.calibration.begin(), map.calibration.end(),
                                    [&](const SavedCalibration& parameter) {
                                      return parameter.name == state.spec(block).name;
                                    });
    const bool taken = start.saved_calibration && saved != map.calibration.end();
    if (taken) state.set_estimate(block, Eigen::VectorXd::Constant(1, saved->mean));
    append_rows(rows, taken ? map.pose_tangent() + (saved - map.calibration.begin()) : kOutside, 1);
  }
  return rows;
}

void enter_landmarks(const MapStart& start, const MappedParts& parts, Rows& rows) {
  const SavedMap& map = *start.map;
  const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(map.dimension, map.dimension);
  Index row = map.landmark_offset();
  for (const SavedLandmark& landmark : map.landmarks) {
    const Index own = row;
    if (!landmark.exact) row += map.dimension;
    if (start.landmarks_given && !landmark.confirmed) continue;
    const BlockId block = landmark.exact ? parts.state.add_constant(parts.landmark, landmark.mean)
                                         : parts.state.add(parts.landmark, landmark.mean, nothing);
    if (!landmark.exact) append_rows(rows, own, map.dimension);
    parts.registry.restore({block, landmark.id, landmark.times_seen, landmark.updates,
                            landmark.confirmed, landmark.appearance, 0, landmark.extent,
                            landmark.prior_judged});
  }
  parts.registry.number_from(map.next_number);
}

bool same_parameters(const SavedMap& map, const MappedParts& parts) {
  const CalibrationBlocks& blocks = parts.calibration.blocks();
  return std::equal(map.calibration.begin(), map.calibration.end(), blocks.begin(), blocks.end(),
                    [&](const SavedCalibration& saved, BlockId block) {
                      return saved.name == parts.state.spec(block).name;
                    });
}

}  // namespace

void enter_map(const MapStart& start, MappedParts parts) {
  require_fit(start, parts);
  const SavedMap& map = *start.map;
  GaussianState& state = parts.state;
  state.reserve(state.dimension() + map.tangent());
  Rows rows = enter_robot(start, parts);
  enter_landmarks(start, parts, rows);
  Eigen::MatrixXd cov = state.full_covariance();
  for (Index c = 0; c < cov.cols(); ++c)
    for (Index r = 0; r < cov.rows(); ++r) {
      const Index row = rows[static_cast<std::size_t>(r)], col = rows[static_cast<std::size_t>(c)];
      if (row != kOutside && col != kOutside) cov(r, c) = map.cov(row, col);
    }
  state.covariance().assign(cov);
  if (start.at_saved_pose && start.saved_calibration && same_parameters(map, parts))
    parts.calibration.remember(map.excitation);
}

SavedMap leave_map(const GaussianState& state, BlockId pose, const CalibrationStates& calibration,
                   const LandmarkRegistry& registry, const BlockSpec& landmark) {
  SavedMap map;
  map.dimension = storage_dimension(landmark);
  map.pose = state.estimate(pose);
  std::vector<BlockId> order{pose};
  for (const BlockId block : calibration.blocks()) {
    map.calibration.push_back({state.spec(block).name, state.estimate(block)[0]});
    order.push_back(block);
  }
  map.excitation = calibration.memory();
  map.next_number = registry.next_number();
  for (const RegisteredLandmark& known : registry.landmarks()) {
    const bool exact = state.is_constant(known.block);
    map.landmarks.push_back({known.id, type_of(landmark), state.estimate(known.block),
                             known.times_seen, known.updates, known.confirmed, exact,
                             known.appearance, known.extent, known.prior_judged});
    if (!exact) order.push_back(known.block);
  }
  Rows rows;
  for (const BlockId block : order) append_rows(rows, state.offset(block), state.size(block));
  map.cov = state.full_covariance()(rows, rows);
  return map;
}

}  // namespace libslam
