#pragma once
// Synthetic stereo pairs whose disparity is known exactly: a smooth texture that is a formula.

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <libslam/frontend/stereo_features.hpp>

namespace libslam::testing {

inline constexpr int kWidth = 320, kHeight = 240;
inline constexpr double kFocal = 300.0, kBaseline = 0.2;

/// A sum of waves of 7 to 40 px in random directions, gray values about 128 with a deviation of 40.
class Texture {
 public:
  explicit Texture(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit;
    for (int i = 0; i < kWaves; ++i) {
      const double k = 2.0 * kPi / (7.0 + 33.0 * unit(random)), angle = 2.0 * kPi * unit(random);
      waves_.push_back({k * std::cos(angle), k * std::sin(angle), 2.0 * kPi * unit(random)});
    }
  }
  double operator()(double x, double y) const {
    double sum = 0.0;
    for (const auto& [kx, ky, phase] : waves_) sum += std::cos(kx * x + ky * y + phase);
    return 128.0 + 40.0 * std::sqrt(2.0 / kWaves) * sum;
  }

 private:
  struct Wave {
    double kx, ky, phase;
  };
  static constexpr int kWaves = 40;
  std::vector<Wave> waves_;
};

using Gray = std::function<double(int x, int y)>;

inline mrpt::img::CImage image_of(const Gray& gray, int width = kWidth, int height = kHeight) {
  mrpt::img::CImage image(width, height, mrpt::img::CH_GRAY);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      *image.ptr<std::uint8_t>(static_cast<unsigned>(x), static_cast<unsigned>(y)) =
          static_cast<std::uint8_t>(std::lround(std::clamp(gray(x, y), 0.0, 255.0)));
  return image;
}

inline mrpt::obs::CObservationStereoImages::Ptr pair_of(const Gray& left, const Gray& right) {
  auto o = mrpt::obs::CObservationStereoImages::Create();
  o->sensorLabel = "stereo";
  o->imageLeft = image_of(left);
  o->imageRight = image_of(right);
  o->hasImageRight = true;
  o->leftCamera.ncols = kWidth;
  o->leftCamera.nrows = kHeight;
  o->leftCamera.setIntrinsicParamsFromValues(kFocal, kFocal, 0.5 * kWidth, 0.5 * kHeight);
  o->rightCamera = o->leftCamera;
  o->rightCameraPose = mrpt::poses::CPose3DQuat(mrpt::poses::CPose3D(kBaseline, 0, 0, 0, 0, 0));
  return o;
}

/// A wall that faces the camera.
inline mrpt::obs::CObservationStereoImages::Ptr wall_at(double disparity, std::uint64_t seed = 1,
                                                        double row_shift = 0.0) {
  const Texture texture(seed);
  return pair_of([&](int x, int y) { return texture(x, y); },
                 [&](int x, int y) { return texture(x + disparity, y + row_shift); });
}

inline FrontendParameters stereo_parameters(const std::string& detector = "orb",
                                            const std::string& tracker = "descriptors") {
  FrontendParameters p;
  p.source = "stereo_images";
  p.stereo.detector = detector;
  p.stereo.tracker = tracker;
  p.stereo.detected = 400;
  p.stereo.delivered = 400;
  return p;
}

/// Features of one observation; empty where there are none.
inline FeatureBatch features_of(Frontend& frontend,
                                const mrpt::obs::CObservationStereoImages::Ptr& observation) {
  mrpt::obs::CSensoryFrame frame;
  frame.insert(observation);
  std::vector<FeatureBatch> batches;
  frontend.extract(frame, batches);
  return batches.empty() ? FeatureBatch{} : batches.front();
}

}  // namespace libslam::testing
