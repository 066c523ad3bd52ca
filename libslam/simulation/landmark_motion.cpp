#include <algorithm>
#include <cmath>
#include <random>

#include <libslam/simulation/landmark_motion.hpp>
#include <libslam/simulation/random_stream.hpp>

namespace libslam {

LandmarkMotion::LandmarkMotion(const MovingLandmarkParameters& parameters,
                               const std::vector<TrueLandmark>& landmarks, std::uint64_t seed)
    : parameters_(parameters) {
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const Eigen::VectorXd& p = landmarks[i].position;
    start_.emplace_back(p.x(), p.y(), p.size() > 2 ? p.z() : 0.0);
    direction_.push_back(Eigen::Vector3d::Zero());
    if (!parameters_.enabled) continue;
    RandomStream random(seed, RandomPurpose::kMovingLandmarks, 0, static_cast<std::uint32_t>(i));
    std::uniform_real_distribution<double> uniform;
    if (uniform(random) >= parameters_.fraction) continue;
    const double heading = 2.0 * kPi * uniform(random);
    direction_.back() = {std::cos(heading), std::sin(heading), 0.0};
    any_ = true;
  }
}

void LandmarkMotion::place(double elapsed, std::vector<Eigen::Vector3d>& p_world) const {
  p_world = start_;
  if (!any_) return;
  const double period = 2.0 * parameters_.distance;
  const double travelled = std::fmod(parameters_.speed * elapsed, period);
  const double along = std::min(travelled, period - travelled);
  for (std::size_t i = 0; i < p_world.size(); ++i) p_world[i] += along * direction_[i];
}

}  // namespace libslam
