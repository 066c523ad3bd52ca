#pragma once
// Where a robot, or a head that somebody carries, is by what its stereo camera sees of a map of
// landmarks; for programs of MRPT.
//
// Given   observations in the order of their times, one after another (processObservation) or as
//         pairs of action and frame (processActionObservation),
// Then    the pose is that of the last one, in space as MRPT's own types have it.
//
// Points come from CObservationStereoImagesFeatures, or with `parameters.frontend.source`
// stereo_images or fiducials from CObservationStereoImages. What moves the pose between them:
//
// - input.odometry twist, the default: velocities of the vehicle, each of which holds until the
//   next reading. Turn rates (IMU_WX, IMU_WY, IMU_WZ) come from CObservationIMU. The velocity comes
//   from a CObservationOdometry with velocities, or from IMU_X_VEL, IMU_Y_VEL, IMU_Z_VEL, which
//   MRPT defines in the frame of navigation, where the IMU gives its orientation in that frame as
//   well.
// - another input.odometry, with a planar motion model: the poses of CObservationOdometry, cut at
//   the images (io/observation_splitter.hpp). An image counts once the reading after it is there.
// - input.odometry none with motion.model constant_twist: nothing.
// - the actions of pairs.

#include <memory>
#include <string>
#include <vector>

#include <mrpt/config/CLoadableOptions.h>
#include <mrpt/poses/poses_frwds.h>
#include <mrpt/system/COutputLogger.h>

#include <libslam/config/parameters.hpp>
#include <libslam/data/step_record.hpp>

namespace mrpt::obs {
class CActionCollection;
class CObservation;
class CSensoryFrame;
}  // namespace mrpt::obs
namespace mrpt::poses {
class CPose3DQuatPDFGaussian;
}
namespace mrpt::serialization {
class CArchive;
}

namespace libslam {

class StereoLocalization : public mrpt::system::COutputLogger {
 public:
  struct TOptions : public mrpt::config::CLoadableOptions {
    TOptions();

    /// From `section`: map_file, a map that slam-run --save-map or saveMap() wrote or landmarks
    /// id,x,y,z; map_sigma [m] of such landmarks; add_landmarks, false: localization alone. The
    /// rest of `parameters` as config/ini_parameters.hpp says. Throws ConfigError
    /// (config/config_error.hpp) naming section and key.
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void dumpToTextStream(std::ostream& out) const override;

    /// Defaults that differ from config/README.md: input.odometry twist, motion.model body_twist,
    /// frontend.source stereo_points, measurement.model stereo_point, association.method
    /// known_or_nearest, map.start given_pose.
    Parameters parameters;
  };
  TOptions options;

  StereoLocalization();
  ~StereoLocalization() override;

  /// Reads `options` and verbosity_level from `section`.
  void loadOptions(const mrpt::config::CConfigFileBase& ini,
                   const std::string& section = "StereoLocalization");

  /// Starts anew, with the options as they are now, at `x0` in the frame of the map; null: where
  /// `parameters.map` and `parameters.filter` say. Must be called before the first observation.
  /// Throws ConfigError if the options cannot run, InputError (io/input_error.hpp) if the map
  /// cannot be read, and std::invalid_argument if it does not fit the filter.
  void initialize(const mrpt::poses::CPose3DPDF* x0 = nullptr);

  /// Observations of other classes pass by. What cannot be used is logged and left out, unless
  /// input.policy is strict, which throws InputError or UnusableOdometry (frontend/odometry.hpp).
  /// Throws std::logic_error before initialize().
  void processObservation(const std::shared_ptr<mrpt::obs::CObservation>& observation);
  void processActionObservation(const std::shared_ptr<mrpt::obs::CActionCollection>& action,
                                const std::shared_ptr<mrpt::obs::CSensoryFrame>& SF);

  /// T_world_robot. Near a pitch of +-90 degrees the angles of the first form are singular.
  void getCurrentPose(mrpt::poses::CPose3DPDFGaussian& out_pose) const;
  void getCurrentPose(mrpt::poses::CPose3DQuatPDFGaussian& out_pose) const;
  /// What became of the points of the last observation, the calibration, the adapted noise, and
  /// what [disturbance] noticed.
  const StepRecord& getLastStep() const;
  /// Landmarks of the map.
  std::vector<LandmarkEstimate> getLandmarks() const;

  /// The map in a file for the next time (io/map_file.hpp); throws like write_map_file.
  void saveMap(const std::string& file) const;
  /// As RangeBearingSlam2D has it. Observations that wait for odometry and the velocity that holds
  /// are not part of it: the first reading afterwards holds for what was before it.
  void saveState(mrpt::serialization::CArchive& out) const;
  void loadState(mrpt::serialization::CArchive& in);

 private:
  struct Impl;
  Impl& running() const;
  void hold(const mrpt::obs::CObservation& reading);
  void drive(const std::shared_ptr<mrpt::obs::CObservation>& observation);
  void process(const std::shared_ptr<mrpt::obs::CActionCollection>& action,
               const std::shared_ptr<mrpt::obs::CSensoryFrame>& frame);
  void process_ready();

  std::unique_ptr<Impl> impl_;
};

}  // namespace libslam
