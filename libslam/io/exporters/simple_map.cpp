#include <cmath>
#include <stdexcept>

#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/math/wrap2pi.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <libslam/io/exporters/simple_map.hpp>
#include <libslam/result/atomic_file.hpp>

namespace libslam {

SimpleMapWriter::SimpleMapWriter(Spacing spacing, std::size_t max_pairs)
    : spacing_(spacing), max_pairs_(max_pairs) {
  if (max_pairs < 2) throw std::invalid_argument("a simple map needs room for two pairs");
  if (!(spacing.distance_m >= 0.0 && spacing.turn_rad >= 0.0))
    throw std::invalid_argument("the spacing of a simple map must not be negative");
}

void SimpleMapWriter::add(const Eigen::Vector3d& pose, const Eigen::Matrix3d& cov,
                          const mrpt::obs::CSensoryFrame::Ptr& frame) {
  if (!frame) return;
  if (!pairs_.empty()) {
    const Eigen::Vector3d moved = pose - pairs_.back().pose;
    if (moved.head<2>().norm() < spacing_.distance_m &&
        std::abs(mrpt::math::wrapToPi(moved.z())) < spacing_.turn_rad)
      return;
  }
  if (pairs_.size() == max_pairs_) drop_every_second();
  pairs_.push_back({pose, cov, frame});
}

void SimpleMapWriter::drop_every_second() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs_.size(); i += 2) pairs_[kept++] = std::move(pairs_[i]);
  pairs_.resize(kept);
  spacing_.distance_m *= 2.0;
  spacing_.turn_rad *= 2.0;
}

void SimpleMapWriter::write(const std::filesystem::path& file) const {
  mrpt::maps::CSimpleMap map;
  for (const Pair& pair : pairs_) {
    mrpt::math::CMatrixDouble33 cov;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) cov(i, j) = pair.cov(i, j);
    const mrpt::poses::CPose2D mean(pair.pose.x(), pair.pose.y(), pair.pose.z());
    map.insert(mrpt::poses::CPosePDFGaussian::Create(mean, cov), pair.frame);
  }
  replace_file(file, [&](const std::filesystem::path& temporary) {
    return map.saveToFile(temporary.string());
  });
}

}  // namespace libslam
