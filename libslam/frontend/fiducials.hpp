#pragma once
// Tags in CObservationStereoImages -> stereo points with known identities.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <libslam/config/parameters.hpp>
#include <libslam/frontend/channel_numbers.hpp>
#include <libslam/frontend/frontend.hpp>

namespace libslam {

class StereoRectifier;
class TagDetector;
struct DetectedTag;

/// Tags are detected in both rectified images and paired by their number, their points by name
/// (data/tag_points.hpp): each is a feature (u, v, d) of its own with the identity of that point.
/// The orientation of a tag is never used: it flips. The centre is where the diagonals meet, which
/// perspective keeps; its noise is that of the mean of four corners.
class Fiducials final : public Frontend {
 public:
  /// Reads the observations labelled `sensor_label`; empty: all. Throws std::invalid_argument on
  /// an unknown family.
  Fiducials(const FrontendParameters& parameters, std::string sensor_label);
  ~Fiducials() override;
  void extract(const mrpt::obs::CSensoryFrame& frame, std::vector<FeatureBatch>& batches) override;
  /// Pairs of images. Points whose rows differ, or whose depth is not known to a third, are left
  /// out without a word.
  std::int64_t unusable() const override { return unusable_; }
  std::vector<std::string> warnings() const override { return warnings_; }

 private:
  StereoRectifier& rectifier_of(int channel);
  void add_points(const DetectedTag& left, const DetectedTag& right,
                  const std::shared_ptr<const StereoCamera>& camera, FeatureBatch& batch);

  FrontendParameters parameters_;
  std::string sensor_label_;
  std::unique_ptr<TagDetector> detector_;
  ChannelNumbers channels_;
  std::vector<std::unique_ptr<StereoRectifier>> rectifiers_;  ///< by channel: tables are kept
  std::int64_t unusable_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace libslam
