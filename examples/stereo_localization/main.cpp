// A head with a stereo camera finds where it is in a map of landmarks.
//
// usage:   stereo_localization MAP.csv [INI]
// example: stereo_localization landmarks.csv
//
// The head is simulated (simulated_head.hpp); with drivers in its place this is the whole program.
// MAP.csv is written first, since a simulated world has no surveyor. INI may have a section
// [StereoLocalization] and those of libslam, such as [adaptation].
// Prints "frames rms_m rms_deg" of the error at the end.

#include <cstdio>
#include <exception>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>

#include <mrpt/config/CConfigFile.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <libslam/modules/stereo_localization.hpp>

#include "simulated_head.hpp"

namespace {

void write_map(const std::string& file, const SimulatedHead& head) {
  std::ofstream out(file);
  out << "id,x,y,z\n";
  for (std::size_t i = 0; i < head.landmarks.size(); ++i)
    out << i << ',' << head.landmarks[i].x() << ',' << head.landmarks[i].y() << ','
        << head.landmarks[i].z() << '\n';
  if (!out.flush()) throw std::runtime_error(file + ": cannot be written");
}

libslam::StereoLocalization::TOptions make_options(const std::string& map) {
  libslam::StereoLocalization::TOptions options;
  libslam::Parameters& p = options.parameters;
  p.map.file = map;
  p.map.sigma = 0.001;  // the survey is this good
  p.measurement.stereo.sigma_pixel = SimulatedHead::kSigmaPixel;
  p.motion.twist.sigma_speed_x = p.motion.twist.sigma_speed_y = SimulatedHead::kSigmaSpeed;
  p.motion.twist.sigma_rate_x = p.motion.twist.sigma_rate_y = SimulatedHead::kSigmaRate;
  p.motion.twist.sigma_rate_z = SimulatedHead::kSigmaRate;
  return options;
}

/// Squared errors of position [m^2] and orientation [deg^2].
Eigen::Vector2d squared_error(const libslam::StereoLocalization& localization,
                              const Eigen::Isometry3d& truth) {
  mrpt::poses::CPose3DPDFGaussian estimate;
  localization.getCurrentPose(estimate);
  const Eigen::Matrix4d T =
      estimate.mean.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
  const Eigen::AngleAxisd turn(
      Eigen::Matrix3d(truth.linear().transpose() * T.topLeftCorner<3, 3>()));
  const double degrees = turn.angle() * 180.0 / std::numbers::pi;
  return {(T.topRightCorner<3, 1>() - truth.translation()).squaredNorm(), degrees * degrees};
}

void run(const std::string& map, const char* ini) {
  SimulatedHead head(1);
  write_map(map, head);
  libslam::StereoLocalization localization;
  localization.options = make_options(map);
  if (ini != nullptr) localization.loadOptions(mrpt::config::CConfigFile(ini));
  // Where it begins is known to half a metre and ten degrees.
  mrpt::poses::CPose3DPDFGaussian start(mrpt::poses::CPose3D(0.3, -0.3, 0.2, 0.1, -0.1, 0.1));
  start.cov.setDiagonal(6, 0.03);
  start.cov(0, 0) = start.cov(1, 1) = start.cov(2, 2) = 0.25;
  localization.initialize(&start);

  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  constexpr int kFrames = 500;
  for (int i = 0; i < kFrames; ++i) {
    for (int k = 0; k < 2; ++k)
      for (const auto& reading : head.move()) localization.processObservation(reading);
    localization.processObservation(head.look());
    sum += squared_error(localization, head.pose);
  }
  const Eigen::Vector2d rms = (sum / kFrames).cwiseSqrt();
  std::printf("%d %.4f %.4f\n", kFrames, rms[0], rms[1]);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: stereo_localization MAP.csv [INI]\n");
    return 2;
  }
  try {
    run(argv[1], argc > 2 ? argv[2] : nullptr);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stereo_localization: %s\n", error.what());
    return 4;
  }
}
