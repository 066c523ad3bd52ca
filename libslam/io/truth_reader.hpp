#pragma once
// Ground truth from files: the forms that libslam's programs write and those that MRPT ships.

#include <map>
#include <string>
#include <vector>

#include <libslam/data/ground_truth.hpp>

namespace libslam {

/// A path, recognised by its number of columns:
///   8  TUM: t x y z qx qy qz qw (time [s], quaternion with w last);
///   6  MRPT: x y z yaw pitch roll without times; row i belongs to step i of the log, counting a
///   leading
///      frame as step 0 (checked on kf-slam_demo: pair k is row k + 1, both from 0).
/// Poses are x, y and yaw; where the path leaves the plane z = 0 or rolls or pitches anywhere,
/// `spatial` holds the full ones.
/// Throws InputError where a row cannot be read, times go backwards or a quaternion is zero.
Trajectory read_true_path(const std::string& file);

/// A map, recognised by its number of columns:
///   3 or 4  id,x,y[,z], a header row with these names is left out;
///   7       MRPT: x y z . . . id.
/// Throws InputError where a row cannot be read or an id comes twice.
std::vector<TrueLandmark> read_true_landmarks(const std::string& file);

/// Relations of the Freiburg SLAM benchmark, `t1 t2 x y z roll pitch yaw`: the pose at t2 seen from
/// the pose at t1, [s], [m] and [rad]; of a robot in the plane, so that z, roll and pitch are 0.
/// Throws InputError where a row cannot be read or leaves the plane.
std::vector<PoseRelation> read_relations(const std::string& file);

/// What X.truth.json says besides its description of the scenario.
struct TruthNotes {
  bool has_heading = true;  ///< the path holds headings, not positions only
  Eigen::Vector2d point_on_robot = Eigen::Vector2d::Zero();  ///< whose positions they are [m]
  std::map<std::string, double> calibration;                 ///< parameter name -> true value
  /// Time of the source -> time in the rawlog, where the import had to mend the clock [s].
  std::map<double, double> mended_times;
};

/// Throws InputError where the file is no JSON object or a value has a wrong type.
TruthNotes read_truth_notes(const std::string& file);

/// Where the truth of a log is; an empty name where there is none.
struct TruthFiles {
  std::string path, landmarks, notes;
  bool notes_describe_path =
      true;  ///< false: `path` is another file than the notes were written for
  std::string relations{};
};

/// The files that stand beside `rawlog` (X.rawlog): X.truth.tum, X.landmarks.csv, X.truth.json,
/// X.relations, else MRPT's X_ground_truth_robot_path.txt and X_ground_truth.txt.
TruthFiles find_truth(const std::string& rawlog);

/// Reads what `files` names. The times of relations, which are those of the source, follow the
/// clock that the notes say was mended. Throws InputError.
GroundTruth read_truth(const TruthFiles& files);

}  // namespace libslam
