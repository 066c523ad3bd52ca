#include <algorithm>
#include <cmath>
#include <filesystem>

#include <Eigen/Dense>
#include <mrpt/img/CImage.h>
#include <mrpt/poses/CPose3D.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <libslam/frontend/png_image.hpp>
#include <libslam/frontend/stereo_rectification.hpp>

namespace libslam {

namespace {

using Observation = mrpt::obs::CObservationStereoImages;
using mrpt::img::TCamera;

/// Larger images are not of a camera, but of somebody who wants our memory.
constexpr int kLargestSide = 16384;
/// Detectors work on images smaller by up to 8 and take their size for granted.
constexpr int kSmallestSide = 64;
/// Calibrations are printed with six digits or so.
constexpr double kNegligible = 1e-6;

std::string name_of(const mrpt::img::CImage& image, const char* side) {
  return image.isExternallyStored() ? "image " + image.getExternalStorageFileAbsolutePath()
                                    : std::string(side) + " image";
}

/// The same words for every image of a folder that is not there.
void require_folder_of(const mrpt::img::CImage& image) {
  if (!image.isExternallyStored()) return;
  const auto folder =
      std::filesystem::path(image.getExternalStorageFileAbsolutePath()).parent_path();
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    throw UnusableImages("the folder of the images is missing: " + folder.string());
}

cv::Mat pixels_of(const mrpt::img::CImage& image, const char* side) {
  require_folder_of(image);
  cv::Mat pixels;
  try {
    const bool beside = image.isExternallyStored();
    const std::string file = beside ? image.getExternalStorageFileAbsolutePath() : std::string();
    if (is_png_name(file)) return read_png(file, kLargestSide);
    image.asCvMat(pixels, mrpt::img::SHALLOW_COPY);
  } catch (const DamagedPng& defect) {
    throw UnusableImages(name_of(image, side) + ": cannot be read: " + defect.what());
  } catch (const std::exception&) {
    throw UnusableImages(name_of(image, side) + ": cannot be read");
  }
  return pixels;
}

cv::Mat gray_of(const mrpt::img::CImage& image, const char* side) {
  const cv::Mat pixels = pixels_of(image, side);
  if (pixels.empty()) throw UnusableImages(name_of(image, side) + ": is empty");
  if (std::max(pixels.rows, pixels.cols) > kLargestSide ||
      std::min(pixels.rows, pixels.cols) < kSmallestSide || pixels.depth() != CV_8U)
    throw UnusableImages(name_of(image, side) +
                         ": is no 8-bit image from 64 x 64 to 16384 x 16384");
  if (pixels.channels() == 1) return pixels;
  cv::Mat gray;
  cv::cvtColor(pixels, gray, pixels.channels() == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
  return gray;
}

void append(std::vector<double>& numbers, const TCamera& camera) {
  numbers.insert(numbers.end(), {camera.fx(), camera.fy(), camera.cx(), camera.cy()});
  numbers.push_back(static_cast<double>(camera.distortion));
  numbers.insert(numbers.end(), camera.dist.begin(), camera.dist.end());
}

void append(std::vector<double>& numbers, const mrpt::poses::CPose3DQuat& pose) {
  for (unsigned i = 0; i < 7; ++i) numbers.push_back(pose[i]);
}

Eigen::Isometry3d isometry_of(const mrpt::poses::CPose3DQuat& pose) {
  const Eigen::Quaterniond q(pose.quat().r(), pose.quat().x(), pose.quat().y(), pose.quat().z());
  return Eigen::Translation3d(pose.x(), pose.y(), pose.z()) * q.normalized();
}

bool distorted(const TCamera& camera) {
  return std::any_of(camera.dist.begin(), camera.dist.end(), [](double k) { return k != 0.0; });
}

cv::Mat intrinsics_of(const TCamera& camera) {
  return (cv::Mat_<double>(3, 3) << camera.fx(), 0, camera.cx(), 0, camera.fy(), camera.cy(), 0, 0,
          1);
}

cv::Mat distortion_of(const TCamera& camera) {
  return cv::Mat(1, 8, CV_64F, const_cast<double*>(camera.dist.data())).clone();
}

bool is_rectified(const Observation& o, const Eigen::Isometry3d& T_left_right) {
  const double baseline = T_left_right.translation().x();
  const Eigen::Vector3d shift(0.0, T_left_right.translation().y(), T_left_right.translation().z());
  const TCamera &l = o.leftCamera, &r = o.rightCamera;
  const Eigen::Vector4d difference(l.fx() - r.fx(), l.fy() - r.fy(), l.cx() - r.cx(),
                                   l.cy() - r.cy());
  return !distorted(l) && !distorted(r) && shift.norm() <= kNegligible * std::abs(baseline) &&
         (T_left_right.linear() - Eigen::Matrix3d::Identity()).norm() <= kNegligible &&
         difference.norm() <= kNegligible * l.fx();
}

Eigen::Matrix3d matrix_of(const cv::Mat& m) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.ptr<double>());
}

cv::Mat matrix_of(const Eigen::Matrix3d& m) {
  cv::Mat out(3, 3, CV_64F);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out.at<double>(i, j) = m(i, j);
  return out;
}

void require_calibration(const std::vector<double>& numbers, const Observation& o) {
  if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
    throw UnusableImages("the calibration of the stereo camera is not finite");
  for (const TCamera* camera : {&o.leftCamera, &o.rightCamera}) {
    if (!(camera->fx() > 0.0) || !(camera->fy() > 0.0))
      throw UnusableImages("a camera has no positive focal length");
    if (camera->distortion == mrpt::img::DistortionModel::kannala_brandt)
      throw UnusableImages("fish-eye distortion (kannala_brandt) is not supported");
  }
  if (!(o.rightCameraPose.x() > 0.0))
    throw UnusableImages("the right camera is not to the right of the left one: baseline " +
                         std::to_string(o.rightCameraPose.x()) + " m");
}

}  // namespace

RectifiedPair StereoRectifier::rectify(const Observation& observation) {
  if (!observation.hasImageRight) throw UnusableImages("stereo observation without right image");
  RectifiedPair pair;
  pair.left = gray_of(observation.imageLeft, "left");
  pair.right = gray_of(observation.imageRight, "right");
  if (pair.left.size() != pair.right.size())
    throw UnusableImages(name_of(observation.imageRight, "right") +
                         ": has another size than the left image");
  adopt_calibration(observation, pair.left.size());
  if (!rectified_) {
    cv::Mat left, right;
    cv::remap(pair.left, left, left_map_[0], left_map_[1], cv::INTER_LINEAR);
    cv::remap(pair.right, right, right_map_[0], right_map_[1], cv::INTER_LINEAR);
    pair.left = left;
    pair.right = right;
  }
  pair.camera = camera_;
  return pair;
}

void StereoRectifier::adopt_calibration(const Observation& o, cv::Size size) {
  std::vector<double> numbers{static_cast<double>(size.width), static_cast<double>(size.height)};
  append(numbers, o.leftCamera);
  append(numbers, o.rightCamera);
  append(numbers, o.cameraPose);
  append(numbers, o.rightCameraPose);
  if (camera_ && numbers == calibration_) return;
  require_calibration(numbers, o);
  const Eigen::Isometry3d T_left_right = isometry_of(o.rightCameraPose);
  camera_.reset();  // until all of the new calibration is there
  rectified_ = is_rectified(o, T_left_right);
  if (rectified_) {
    const TCamera& c = o.leftCamera;
    camera_ = std::make_shared<StereoCamera>(
        StereoCamera{c.fx(), c.fy(), c.cx(), c.cy(), T_left_right.translation().x(), size.width,
                     size.height, isometry_of(o.cameraPose)});
  } else {
    compute_tables(o, size);
  }
  calibration_ = std::move(numbers);
}

void StereoRectifier::compute_tables(const Observation& o, cv::Size size) {
  const cv::Mat K_left = intrinsics_of(o.leftCamera), K_right = intrinsics_of(o.rightCamera);
  const cv::Mat D_left = distortion_of(o.leftCamera), D_right = distortion_of(o.rightCamera);
  const Eigen::Isometry3d T_right_left = isometry_of(o.rightCameraPose).inverse();
  const Eigen::Vector3d t = T_right_left.translation();
  const cv::Mat shift = (cv::Mat_<double>(3, 1) << t.x(), t.y(), t.z());
  cv::Mat R_left, R_right, P_left, P_right, Q;
  cv::stereoRectify(K_left, D_left, K_right, D_right, size, matrix_of(T_right_left.linear()), shift,
                    R_left, R_right, P_left, P_right, Q, cv::CALIB_ZERO_DISPARITY, 0.0);
  cv::initUndistortRectifyMap(K_left, D_left, R_left, P_left, size, CV_16SC2, left_map_[0],
                              left_map_[1]);
  cv::initUndistortRectifyMap(K_right, D_right, R_right, P_right, size, CV_16SC2, right_map_[0],
                              right_map_[1]);
  StereoCamera camera{P_left.at<double>(0, 0),
                      P_left.at<double>(1, 1),
                      P_left.at<double>(0, 2),
                      P_left.at<double>(1, 2),
                      -P_right.at<double>(0, 3) / P_right.at<double>(0, 0),
                      size.width,
                      size.height,
                      isometry_of(o.cameraPose)};
  if (!(camera.baseline > 0.0))
    throw UnusableImages("the images cannot be rectified: no horizontal baseline");
  camera.T_robot_camera.rotate(matrix_of(R_left).transpose());  // X_rectified = R_left X_left
  camera_ = std::make_shared<StereoCamera>(camera);
}

}  // namespace libslam
