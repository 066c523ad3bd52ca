#pragma once
// Stereo images of the KITTI odometry benchmark (A. Geiger, P. Lenz, R. Urtasun, "Are we ready for
// autonomous driving?", CVPR 2012) -> rawlog with images beside it.

#include <cstdint>
#include <functional>
#include <string>

namespace libslam {

struct KittiImagesSummary {
  std::int64_t pairs = 0, true_poses = 0;
  double baseline = 0.0;  ///< [m]
  bool complete = true;   ///< false: interrupted
};

/// `directory` holds image_l and image_r (or image_0 and image_1, or image_2 and image_3) with
/// 000000.png ..., calib.txt with the projection matrices of both cameras (3 x 4, row by row, with
/// or without "P0:" before them), and where known times.txt [s] and poses.txt (3 x 4, left camera
/// in that of the first pair). Without times.txt pairs are 0.1 s apart, as the benchmark's are.
///
/// Writes `rawlog` (X.rawlog) of rectified CObservationStereoImages, whose images are copied to
/// X_Images, where MRPT looks for them; X.truth.tum and X.truth.json. The robot is the left camera
/// with axes x forward, y left, z up; the truth is the pose of this frame in that of the first
/// pair. Throws InputError, and std::runtime_error where a file cannot be written. `interrupted` is
/// asked for every pair.
KittiImagesSummary import_kitti_images(const std::string& directory, const std::string& rawlog,
                                       const std::function<bool()>& interrupted = {});

}  // namespace libslam
