#pragma once
// CObservation2DRangeScan -> straight lines: z = (alpha [rad], r [m]) in the frame of the sensor,
// the normal pointing from the sensor to the wall, with the part of the line that was seen. The
// longest line comes first.

#include <libslam/config/parameters.hpp>
#include <libslam/frontend/channel_numbers.hpp>
#include <libslam/frontend/frontend.hpp>
#include <libslam/frontend/line_extraction.hpp>

namespace mrpt::obs {
class CObservation2DRangeScan;
}

namespace libslam {

/// Scanners that see in a plane parallel to the ground, either side up. Keeps its memory: from the
/// second scan of a kind on nothing is allocated.
class ScanLines final : public Frontend {
 public:
  /// Uses the scans labelled `sensor_label`; empty: all.
  ScanLines(const FrontendParameters& parameters, std::string sensor_label);

  /// Scans of a tilted sensor and beams that are not finite count as unusable; beams without an
  /// echo or beyond the ranges of the parameters are left out in silence.
  void extract(const mrpt::obs::CSensoryFrame& frame, std::vector<FeatureBatch>& batches) override;
  std::span<const Eigen::Vector2d> surface_points() const override { return surface_; }
  std::int64_t unusable() const override { return unusable_; }
  std::vector<std::string> warnings() const override { return warnings_; }
  /// scans, mean_lines.
  std::map<std::string, double> figures() const override;

 private:
  /// False, and counted, if the scanner is tilted.
  bool accepts(const mrpt::obs::CObservation2DRangeScan& scan);

  FrontendParameters parameters_;
  std::string sensor_label_;
  ChannelNumbers channels_;
  LineExtraction extraction_;
  std::vector<BeamPoint> points_;
  std::vector<Eigen::Vector2d> surface_;
  std::vector<std::string> warnings_;
  std::int64_t unusable_ = 0, scans_ = 0, lines_ = 0;
};

}  // namespace libslam
