#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <mrpt/math/CQuaternion.h>
#include <mrpt/math/distributions.h>
#include <mrpt/opengl/CEllipsoid2D.h>
#include <mrpt/opengl/CEllipsoid3D.h>
#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/stock_objects.h>
#include <mrpt/poses/CPose3D.h>

#include <libslam/io/exporters/scene_3d.hpp>
#include <libslam/result/atomic_file.hpp>
#include <libslam/result/spatial_alignment.hpp>

namespace libslam {
namespace {

using mrpt::opengl::CRenderizable;

constexpr std::size_t kPathPoints = 20000;

/// 1, 2 or 5 times a power of ten, about a twentieth of `extent`.
double grid_spacing(double extent) {
  const double spacing = std::max(extent, 1.0) / 20.0;
  const double decade = std::pow(10.0, std::floor(std::log10(spacing)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= spacing) return factor * decade;
  return 10.0 * decade;
}

CRenderizable::Ptr make_grid(const std::vector<SpatialPose>& path, const LandmarkMap& map) {
  Eigen::AlignedBox2d box(Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1));
  for (const SpatialPose& pose : path) box.extend(pose.position.head<2>());
  for (const LandmarkEstimate& landmark : map)
    if (landmark.type == "point" && landmark.mean.size() >= 2) box.extend(landmark.mean.head<2>());
  const double spacing = grid_spacing(box.sizes().maxCoeff());
  const auto down = [spacing](double v) {
    return static_cast<float>(spacing * (std::floor(v / spacing) - 1));
  };
  const auto up = [spacing](double v) {
    return static_cast<float>(spacing * (std::ceil(v / spacing) + 1));
  };
  auto grid = mrpt::opengl::CGridPlaneXY::Create(down(box.min().x()), up(box.max().x()),
                                                 down(box.min().y()), up(box.max().y()), 0.0f,
                                                 static_cast<float>(spacing));
  grid->setColor_u8(0xb0, 0xb0, 0xb0, 0xa0);
  return grid;
}

CRenderizable::Ptr make_path(const std::vector<SpatialPose>& path) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  lines->setName("path");
  lines->setColor_u8(0x00, 0x72, 0xb2);
  lines->setLineWidth(2.0f);
  const std::size_t stride =
      std::max<std::size_t>(1, (path.size() + kPathPoints - 1) / kPathPoints);
  for (std::size_t i = 0; i + 1 < path.size(); i += stride) {
    const Eigen::Vector3d& from = path[i].position;
    const Eigen::Vector3d& to = path[std::min(i + stride, path.size() - 1)].position;
    lines->appendLine(from.x(), from.y(), from.z(), to.x(), to.y(), to.z());
  }
  return lines;
}

CRenderizable::Ptr make_robot(const SpatialPose& pose) {
  const auto& p = pose.position;
  const auto& q = pose.rotation;
  auto robot = mrpt::opengl::stock_objects::CornerXYSimple(1.0f, 2.0f);
  robot->setPose(mrpt::poses::CPose3D(mrpt::math::CQuaternionDouble(q.w(), q.x(), q.y(), q.z()),
                                      p.x(), p.y(), p.z()));
  robot->setName("robot");
  return robot;
}

/// An ellipsoid in the plane for 2-D landmarks, in space for 3-D ones.
template <typename Ellipsoid, typename Covariance>
CRenderizable::Ptr make_ellipsoid(const Covariance& cov, int dimension) {
  auto ellipsoid = Ellipsoid::Create();
  typename Ellipsoid::cov_matrix_t matrix;
  for (int i = 0; i < dimension; ++i)
    for (int j = 0; j < dimension; ++j) matrix(i, j) = cov(i, j);
  ellipsoid->setCovMatrix(matrix);
  // An approximation, within 1 % here: good enough for a drawing.
  const double square = mrpt::math::chi2inv(0.95, static_cast<unsigned>(dimension));
  ellipsoid->setQuantiles(static_cast<float>(std::sqrt(square)));
  return ellipsoid;
}

CRenderizable::Ptr make_landmark(const LandmarkEstimate& landmark) {
  const bool flat = landmark.mean.size() == 2;
  auto ellipsoid = flat ? make_ellipsoid<mrpt::opengl::CEllipsoid2D>(landmark.cov, 2)
                        : make_ellipsoid<mrpt::opengl::CEllipsoid3D>(landmark.cov, 3);
  ellipsoid->setLocation(landmark.mean(0), landmark.mean(1), flat ? 0.0 : landmark.mean(2));
  ellipsoid->setColor_u8(0xd5, 0x5e, 0x00);
  ellipsoid->setName(std::to_string(landmark.id));
  ellipsoid->enableShowName();
  return ellipsoid;
}

}  // namespace

void write_scene_3d(const std::filesystem::path& file, const Trajectory& path,
                    const LandmarkMap& map) {
  const std::vector<SpatialPose> poses =
      path.spatial.empty() ? lift_to_space(path.poses) : path.spatial;
  mrpt::opengl::COpenGLScene scene;
  scene.insert(make_grid(poses, map));
  scene.insert(make_path(poses));
  if (!poses.empty()) scene.insert(make_robot(poses.back()));
  for (const LandmarkEstimate& landmark : map)
    if (landmark.type == "point" && (landmark.mean.size() == 2 || landmark.mean.size() == 3))
      scene.insert(make_landmark(landmark));
  replace_file(file, [&](const std::filesystem::path& temporary) {
    return scene.saveToFile(temporary.string());
  });
}

}  // namespace libslam
