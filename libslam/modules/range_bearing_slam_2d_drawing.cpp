#include <fstream>
#include <stdexcept>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/math/utils.h>
#include <mrpt/opengl/CEllipsoid2D.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/stock_objects.h>

#include <libslam/modules/range_bearing_slam_2d.hpp>
#include <libslam/modules/range_bearing_slam_2d_impl.hpp>

namespace libslam {

namespace {

mrpt::opengl::CEllipsoid2D::Ptr make_ellipse(const Eigen::Vector2d& mean,
                                             const Eigen::Matrix2d& cov, float quantiles) {
  auto ellipse = mrpt::opengl::CEllipsoid2D::Create();
  mrpt::opengl::CEllipsoid2D::cov_matrix_t matrix;
  matrix.asEigen() = cov.cast<mrpt::opengl::CEllipsoid2D::cov_matrix_t::Scalar>();
  ellipse->setCovMatrix(matrix);
  ellipse->setLocation(mean.x(), mean.y(), 0.0);
  ellipse->enableDrawSolid3D(false);
  ellipse->setQuantiles(quantiles);
  return ellipse;
}

std::string matlab_ellipse(const Eigen::Vector2d& mean, const Eigen::Matrix2d& cov, float quantiles,
                           const std::string& style) {
  mrpt::math::CMatrixDouble matrix(2, 2);
  matrix.asEigen() = cov;
  mrpt::math::CVectorDouble centre(2);
  centre.asEigen() = mean;
  return mrpt::math::MATLAB_plotCovariance2D(matrix, centre, quantiles, style);
}

}  // namespace

void RangeBearingSlam2D::getAs3DObject(std::shared_ptr<mrpt::opengl::CSetOfObjects>& outObj) const {
  if (!outObj) outObj = mrpt::opengl::CSetOfObjects::Create();
  outObj->clear();
  outObj->insert(mrpt::opengl::stock_objects::CornerXYZ());
  const float quantiles = options.quantiles_3D_representation;
  auto robot =
      make_ellipse(impl_->pose().head<2>(), impl_->cov_pose().topLeftCorner<2, 2>(), quantiles);
  robot->setColor(1, 0, 0);
  outObj->insert(robot);
  const GaussianState& state = impl_->filter().state();
  int position = 0;
  for (const RegisteredLandmark& landmark : impl_->filter().registry().landmarks()) {
    auto ellipse = make_ellipse(state.estimate(landmark.block), state.covariance_of(landmark.block),
                                quantiles);
    ellipse->setColor(0, 0, 1);
    ellipse->setName(std::to_string(position++));
    ellipse->enableShowName(true);
    outObj->insert(ellipse);
  }
}

void RangeBearingSlam2D::saveMapAndPath2DRepresentationAsMATLABFile(
    const std::string& fil, float stdCount, const std::string& styleLandmarks,
    const std::string& stylePath, const std::string& styleRobot) const {
  std::ofstream file(fil);
  const GaussianState& state = impl_->filter().state();
  file << "% Map and robot of libslam::RangeBearingSlam2D, lengths in metres\nhold on;\n\n";
  for (const RegisteredLandmark& landmark : impl_->filter().registry().landmarks())
    file << matlab_ellipse(state.estimate(landmark.block), state.covariance_of(landmark.block),
                           stdCount, styleLandmarks);
  if (!impl_->path.empty()) {
    file << "\nROB_PATH=[";
    for (const Eigen::Vector2d& point : impl_->path) file << point.x() << ' ' << point.y() << ";\n";
    file << "];\nplot(ROB_PATH(:,1),ROB_PATH(:,2),'" << stylePath << "');\n";
  }
  file << matlab_ellipse(impl_->pose().head<2>(), impl_->cov_pose().topLeftCorner<2, 2>(), stdCount,
                         styleRobot)
       << "\naxis equal;\n";
  if (!file.flush()) throw std::runtime_error(fil + ": cannot be written");
}

}  // namespace libslam
