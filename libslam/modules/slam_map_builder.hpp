#pragma once
// libslam as a mrpt::slam::CMetricMapBuilder: what takes a map builder runs our SLAM.
//
// The filter, its models and its front-end are what `slam_options.parameters` describe; features
// come from the observations of the sensory frames (CObservationBearingRange by default). On its
// way it keeps key frames, as MRPT's other builders do, and makes of them the metric maps that
// `slam_options.mapInitializers` ask for; the landmarks stand behind them as a
// mrpt::maps::CBeaconMap, which MRPT's tools draw with their ellipsoids.
//
// - A key frame has the pose that was best when it was taken; later corrections do not reach it.
// - Options of the filter count as they are at construction, initialize(), clear() or at the first
//   pair, whichever is last.
// - options.enableMapUpdating false: localization alone. No key frames and no landmarks are added,
//   and landmarks of the map stay as they are; their uncertainty counts.
// - Every method may be called from any thread. The map behind getCurrentlyBuiltMetricMap() changes
//   with the next pair.

#include <memory>
#include <string>
#include <vector>

#include <mrpt/config/CLoadableOptions.h>
#include <mrpt/maps/TMetricMapInitializer.h>
#include <mrpt/slam/CMetricMapBuilder.h>

#include <libslam/config/parameters.hpp>

namespace mrpt::serialization {
class CArchive;
}

namespace libslam {

struct AdaptedNoise;      // libslam/data/step_record.hpp
struct CalibrationValue;  // libslam/data/step_record.hpp

class SlamMapBuilder final : public mrpt::slam::CMetricMapBuilder {
 public:
  struct TConfigParams : public mrpt::config::CLoadableOptions {
    TConfigParams();

    /// insertionLinDistance, insertionAngDistance [deg] and the list of maps from `section` and
    /// those that belong to it, named as for MRPT's CMetricMapBuilderICP; `parameters` as
    /// config/ini_parameters.hpp says. Throws ConfigError (config/config_error.hpp) naming section
    /// and key.
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void dumpToTextStream(std::ostream& out) const override;

    double insertionLinDistance{1.0};  ///< [m] between key frames
    double insertionAngDistance;       ///< [rad] between key frames, 30 deg
    /// Metric maps made of the key frames, such as an occupancy grid of laser scans. May be empty.
    mrpt::maps::TSetOfMetricMapInitializers mapInitializers;
    /// The filter; defaults as in config/README.md.
    Parameters parameters;
  };
  TConfigParams slam_options;

  SlamMapBuilder();
  ~SlamMapBuilder() override;

  /// Reads `slam_options`, and enableMapUpdating, debugForceInsertion, alwaysInsertByClass and
  /// verbosity_level of `options`, from `section`.
  void loadOptions(const mrpt::config::CConfigFileBase& ini,
                   const std::string& section = "MappingApplication");

  /// Starts anew at `x0`, in the frame of `initialMap`; null: the pose stays as it is. Landmarks
  /// come from a map that this class wrote, with their covariance; from another map they are what
  /// the front-end sees in its frames, from poses that count as exact (in space there are none
  /// then). Throws ConfigError if the options cannot run, InputError (io/input_error.hpp) if the
  /// landmarks in the map are damaged, and std::invalid_argument if they do not fit the filter.
  void initialize(const mrpt::maps::CSimpleMap& initialMap = mrpt::maps::CSimpleMap(),
                  const mrpt::poses::CPosePDF* x0 = nullptr) override;

  /// The pose as a mrpt::poses::CPose3DPDFGaussian.
  mrpt::poses::CPose3DPDF::Ptr getCurrentPoseEstimation() const override;

  /// One step: odometry of `action`, if it has any, then what `observations` show. A movement that
  /// cannot be used is logged and taken for none, unless input.policy is strict, which throws
  /// (UnusableOdometry, frontend/odometry.hpp; InputError, io/input_error.hpp).
  void processActionObservation(mrpt::obs::CActionCollection& action,
                                mrpt::obs::CSensoryFrame& observations) override;

  /// Key frames with their poses. The last one also carries the landmarks, as an observation that
  /// other programs pass over: saveCurrentMapToFile() loses nothing of the map.
  void getCurrentlyBuiltMap(mrpt::maps::CSimpleMap& out_map) const override;
  /// Number of key frames.
  unsigned int getCurrentlyBuiltMapSize() override;
  const mrpt::maps::CMultiMetricMap* getCurrentlyBuiltMetricMap() const override;
  /// Grid, if there is one, landmarks, key frames and robot as a picture; the ending of `file` says
  /// in which format, the second argument is ignored. Throws std::runtime_error if it cannot be
  /// written.
  void saveCurrentEstimationToImage(const std::string& file, bool formatEMF_BMP = true) override;

  /// Everything that the next pair depends on, and the key frames: what runs on after loadState(),
  /// with the same options, gives the results of a run without a break. What policies learned and
  /// the phase of an update schedule start anew. saveState() throws std::invalid_argument if the
  /// filter has diverged; loadState() throws InputError on anything that is no saved state, or is
  /// damaged or cut off, and then changes nothing.
  void saveState(mrpt::serialization::CArchive& out) const;
  void loadState(mrpt::serialization::CArchive& in);

  /// The calibration parameters that `slam_options.parameters.calibration` enables.
  std::vector<CalibrationValue> getCurrentCalibration() const;
  /// The noise that [adaptation] believes in; empty where it is off.
  std::vector<AdaptedNoise> getCurrentNoise() const;
  /// What [disturbance] noticed in the last pair: "disturbance", "lost", "relocalized" or nothing;
  /// several are joined by "+".
  std::string getLastEvent() const;

 private:
  struct Impl;

  // All of these expect the critical section to be entered.
  void start(const mrpt::maps::CSimpleMap& map, const mrpt::poses::CPosePDF* x0);
  void process(const mrpt::obs::CActionCollection::Ptr& action,
               const mrpt::obs::CSensoryFrame::Ptr& frame);
  bool is_key_frame(const mrpt::obs::CSensoryFrame& frame) const;
  void hold_map_on_demand();

  std::mutex& critical_ = critZoneChangingMap;  // the same for const methods
  std::unique_ptr<Impl> impl_;
};

}  // namespace libslam
