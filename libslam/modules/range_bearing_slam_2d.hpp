#pragma once
// The face of mrpt::slam::CRangeBearingKFSLAM2D (MRPT 2.5) over libslam's filter: a program
// switches by changing one type. Methods, options and their names are MRPT's on purpose, camelCase
// and all; examples/kf_slam_2d is one source for both classes.
//
// By default the result is that of MRPT's class with method kfEKFNaive (tests/oracle: to 1e-8 at
// every step). `options.parameters` adds what MRPT's class does not have: odometry calibration on
// line ([calibration] in an ini file), adapted noise ([adaptation]), the answer to slip and kidnap
// ([disturbance]), other motion models, the right-invariant error frame, per-observation noise, a
// dead zone between sightings and new landmarks. config/mrpt_adaptive.ini is an example. Where both
// differ:
// - Motion before the first landmark counts; MRPT discards it. Only a pair without odometry adds no
//   noise then, since the world is where the robot stands.
// - Every CObservationBearingRange of a frame is used; MRPT takes the first. A frame without one is
//   a step of motion alone, where MRPT throws. Measurements that are not finite or not positive
//   are left out, and so is a second observation of one identity in a frame.
// - Observations without identity: nearest neighbour, one-to-one, best d^2 + log|S| first, inside
//   the chi-square gate `data_assoc_IC_chi2_thres`. There is no JCBB and no gate by likelihood; a
//   warning is logged if they are asked for.
// - Options count as they are at the first pair after construction or reset().

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <mrpt/config/CLoadableOptions.h>
#include <mrpt/math/CVectorDynamic.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/math_frwds.h>
#include <mrpt/poses/poses_frwds.h>
#include <mrpt/system/COutputLogger.h>

#include <libslam/config/parameters.hpp>

namespace mrpt::obs {
class CActionCollection;
class CSensoryFrame;
}  // namespace mrpt::obs
namespace mrpt::opengl {
class CSetOfObjects;
}
namespace mrpt::serialization {
class CArchive;
}

namespace libslam {

struct AdaptedNoise;      // libslam/data/step_record.hpp
struct CalibrationValue;  // libslam/data/step_record.hpp

class RangeBearingSlam2D : public mrpt::system::COutputLogger {
 public:
  using landmark_point_t = mrpt::math::TPoint2D;

  RangeBearingSlam2D();
  ~RangeBearingSlam2D() override;

  /// Empties the map and puts the robot back to (0, 0, 0). Throws ConfigError
  /// (config/config_error.hpp) if the options cannot run.
  void reset();

  /// One step: odometry of `action`, if it has any, then the landmarks of `SF`. Either may be null.
  /// Throws ConfigError at the first pair if the options cannot run, and UnusableOdometry
  /// (frontend/odometry.hpp) for a movement in space, with the state unchanged. A movement that is
  /// not finite is logged and taken for none, unless `options.parameters.input.policy` is strict,
  /// which throws InputError (io/input_error.hpp).
  void processActionObservation(std::shared_ptr<mrpt::obs::CActionCollection>& action,
                                std::shared_ptr<mrpt::obs::CSensoryFrame>& SF);

  /// Pose, landmarks and their identities by position in the state, state (3 + 2M: x, y, phi [m,
  /// rad], then x, y of each landmark) and its covariance. A landmark without identity has its
  /// position as one. Calibration is marginalized out; see getCurrentCalibration().
  void getCurrentState(mrpt::poses::CPosePDFGaussian& out_robotPose,
                       std::vector<mrpt::math::TPoint2D>& out_landmarksPositions,
                       std::map<unsigned int, std::int64_t>& out_landmarkIDs,
                       mrpt::math::CVectorDouble& out_fullState,
                       mrpt::math::CMatrixDynamic<double>& out_fullCovariance) const;
  void getCurrentRobotPose(mrpt::poses::CPosePDFGaussian& out_robotPose) const;
  /// The calibration parameters that `options.parameters.calibration` enables.
  std::vector<CalibrationValue> getCurrentCalibration() const;
  /// The noise that `options.parameters.policies.noise_adaptation` believes in; empty where it is
  /// off.
  std::vector<AdaptedNoise> getCurrentNoise() const;
  /// What `options.parameters.policies.disturbance` noticed in the last pair: "disturbance",
  /// "lost", "relocalized" or nothing; several are joined by "+".
  std::string getLastEvent() const;

  /// Everything that the next pair depends on: what runs on after loadState(), with the same
  /// options, gives the results of a run without a break. What policies learned and the phase of an
  /// update schedule start anew. saveState() throws std::invalid_argument if the filter has
  /// diverged or has no landmarks to its model; loadState() throws InputError (io/input_error.hpp)
  /// on anything that is no saved state, or is damaged or cut off, std::invalid_argument if the
  /// state does not fit the options, and then changes nothing.
  void saveState(mrpt::serialization::CArchive& out) const;
  void loadState(mrpt::serialization::CArchive& in);

  /// Ellipses of the landmarks and of the robot, scaled by `options.quantiles_3D_representation`.
  /// Replaces the content of `outObj`; makes one if it is null.
  void getAs3DObject(std::shared_ptr<mrpt::opengl::CSetOfObjects>& outObj) const;
  /// A MATLAB script that draws map, robot and, with `options.create_simplemap`, the path. Throws
  /// std::runtime_error if the file cannot be written.
  void saveMapAndPath2DRepresentationAsMATLABFile(const std::string& fil, float stdCount = 3.0f,
                                                  const std::string& styleLandmarks = "b",
                                                  const std::string& stylePath = "r",
                                                  const std::string& styleRobot = "r") const;

  /// Reads [RangeBearingKFSLAM], [RangeBearingKFSLAM_KalmanFilter] and the sections [libslam.*].
  void loadOptions(const mrpt::config::CConfigFileBase& ini);

  struct TOptions : public mrpt::config::CLoadableOptions {
    TOptions();

    /// MRPT's keys from `section`, also the older stdXY_no_odo, stdPhi_no_odo_deg and
    /// force_ignore_odometry; `parameters` from sections named after those of config/README.md:
    /// [libslam.filter] error_frame = right_invariant, and by the short names [calibration],
    /// [adaptation] and [disturbance] (config/ini_parameters.hpp). Throws ConfigError naming
    /// section and key on a key of [libslam.*] that is unknown, has a bad value, or belongs to one
    /// of MRPT's options.
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void dumpToTextStream(std::ostream& out) const override;

    /// What the filter runs with: `parameters` with MRPT's options written over it. Throws
    /// ConfigError with the first conflict.
    Parameters getEffectiveParameters() const;

    /// Standard deviation in x, y [m], phi [rad] of a step without odometry; x and y must be equal.
    mrpt::math::CVectorFloat stds_Q_no_odo;
    float std_sensor_range{0.1f};          ///< [m]
    float std_sensor_yaw;                  ///< [rad], 0.5 deg
    float quantiles_3D_representation{3};  ///< radius of drawn ellipses in standard deviations
    bool create_simplemap{false};          ///< keep the path for the MATLAB file

    // Numbers of MRPT's enumerations, whose header would cost every user a second: MRPT's
    // enumerators can be assigned.
    int data_assoc_method{0};                ///< mrpt::slam::assocNN; assocJCBB is replaced by it
    int data_assoc_metric{0};                ///< ignored: d^2 + log|S| ranks partners
    double data_assoc_IC_chi2_thres{0.99};   ///< probability of the gate; identities are not gated
    int data_assoc_IC_metric{0};             ///< mrpt::slam::metricMaha; metricML is replaced by it
    double data_assoc_IC_ml_threshold{0.0};  ///< ignored

    /// Everything else. Overwritten by the options above: measurement.sigma_range,
    /// .sigma_bearing_deg, motion.no_odometry_sigma_xy, .no_odometry_sigma_heading_deg,
    /// association.gate_probability. Defaults that differ from config/README.md, to equal MRPT's
    /// class: filter.error_frame standard (choose right_invariant with calibration: consistency
    /// depends on it), measurement.noise configured, association.method known_or_nearest,
    /// association.new_landmark_probability 0 (raised to the gate: no dead zone).
    Parameters parameters;
  };
  TOptions options;

  /// Accepted for compatibility: `method` takes mrpt::bayes::TKFMethod; there is one joint update,
  /// kfEKFNaive, and a warning is logged if another is asked for.
  struct TKalmanOptions : public mrpt::config::CLoadableOptions {
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void dumpToTextStream(std::ostream& out) const override;
    int method{0};
  };
  TKalmanOptions KF_options;

  /// What became of the observations of the last frame. Keys count the usable measurements of the
  /// frame in their order, values are positions of landmarks in the state at that time.
  struct TDataAssocInfo {
    struct TResults {
      std::map<std::size_t, std::size_t> associations;
      double distance{0};  ///< squared Mahalanobis distance of the joint update
    };
    std::vector<std::size_t> predictions_IDs;  ///< candidates: all landmarks before the frame
    std::map<std::size_t, std::size_t> newly_inserted_landmarks;
    TResults results;
  };
  const TDataAssocInfo& getLastDataAssociation() const { return association_; }

 private:
  struct Impl;
  void start();
  void warn_about_options() const;
  void report_step();

  std::unique_ptr<Impl> impl_;
  TDataAssocInfo association_;
};

}  // namespace libslam
