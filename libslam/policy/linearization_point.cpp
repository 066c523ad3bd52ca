#include <libslam/policy/linearization_point.hpp>

namespace libslam {

namespace {

const BlockVector* find_point(const std::map<BlockId, BlockVector>& points, BlockId block) {
  const auto found = points.find(block);
  return found == points.end() ? nullptr : &found->second;
}

}  // namespace

Eigen::Vector2d FirstEstimates::add_landmark(BlockId block, std::int64_t,
                                             const Eigen::Vector2d& reached) {
  first_[block] = reached;  // a handle may have belonged to a landmark that was given up
  return Eigen::Vector2d::Zero();
}

const BlockVector* FirstEstimates::find(BlockId block) const {
  return find_point(first_, block);
}

TruthPoint::TruthPoint(const TrueState& truth) : truth_(truth) {}

void TruthPoint::add_block(BlockId block, const BlockSpec& spec) {
  if (spec.role == WorldRole::kPose) {
    pose_ = block;
    points_[block] = truth_.pose;
  } else if (const auto value = truth_.calibration.find(spec.name);
             value != truth_.calibration.end()) {
    points_[block] = BlockVector::Constant(1, value->second);
  }
}

Eigen::Vector2d TruthPoint::add_landmark(BlockId block, std::int64_t identity,
                                         const Eigen::Vector2d& reached) {
  const auto known = truth_.landmarks.find(identity);
  points_[block] = known == truth_.landmarks.end() ? reached : known->second;
  return points_[block] - reached;
}

const BlockVector* TruthPoint::find(BlockId block) const {
  return find_point(points_, block);
}

Eigen::Vector2d TruthPoint::move(const Eigen::Vector2d& reached) {
  points_[pose_] = truth_.pose;
  return truth_.pose.head<2>() - reached;
}

}  // namespace libslam
