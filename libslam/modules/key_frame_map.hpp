#pragma once
// Poses with what was seen there, and the metric maps made of them: what a map builder of MRPT
// shows to its users.

#include <memory>
#include <optional>

#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/TMetricMapInitializer.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <libslam/data/step_record.hpp>

namespace mrpt::maps {
class CBeaconMap;
}

namespace libslam {

class KeyFrameMap {
 public:
  /// When a frame is kept: where the robot moved so far [m] or turned so far [rad] since the last.
  struct Spacing {
    double distance = 1.0;
    double angle = 0.5;
  };

  /// Empty maps as `metric_maps` describes them, and a CBeaconMap for the landmarks behind them.
  explicit KeyFrameMap(const mrpt::maps::TSetOfMetricMapInitializers& metric_maps);

  /// Takes in the frames of an earlier map at its mean poses.
  void insert(const mrpt::maps::CSimpleMap& earlier);
  bool is_due(const mrpt::poses::CPose3D& T_world_robot, const Spacing& spacing) const;
  void insert(const mrpt::poses::CPose3DPDFGaussian& T_world_robot,
              const mrpt::obs::CSensoryFrame::Ptr& frame);

  /// Shows these landmarks from now on; a planar one lies on the ground.
  void show(const std::vector<LandmarkEstimate>& landmarks);

  const mrpt::maps::CSimpleMap& key_frames() const { return key_frames_; }
  const mrpt::maps::CMultiMetricMap& metric_map() const { return metric_map_; }

 private:
  mrpt::maps::CSimpleMap key_frames_;
  mrpt::maps::CMultiMetricMap metric_map_;
  std::shared_ptr<mrpt::maps::CBeaconMap> landmarks_;
  std::optional<mrpt::poses::CPose3D> last_;
};

}  // namespace libslam
