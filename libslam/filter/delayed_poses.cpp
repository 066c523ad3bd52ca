#include <stdexcept>
#include <string>

#include <libslam/filter/delayed_poses.hpp>

namespace libslam {

DelayedPoses::DelayedPoses(double spacing) : spacing_(spacing), travelled_(spacing) {
  if (!(spacing > 0.0))
    throw std::invalid_argument("delayed poses must be apart, not " + std::to_string(spacing) +
                                " m");
}

void DelayedPoses::update(GaussianState& state, BlockId pose) {
  if (travelled_ < spacing_) return;
  travelled_ = 0.0;
  const Eigen::Index d = state.size(pose);
  clone_.estimate = state.estimate(pose);
  clone_.wrt.clear();
  clone_.wrt.add(pose, d, d).setIdentity();
  clone_.cov_noise.setZero(d, d);
  BlockSpec spec = state.spec(pose);
  spec.name = "delayed_pose";
  poses_.push_back(state.augment(spec, clone_));
}

}  // namespace libslam
