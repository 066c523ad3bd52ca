// Victoria Park as a graph, in the text form of iSAM (Kaess):
//   ODOMETRY i j dx dy dphi  n11 n12 n13 n22 n23 n33
//   LANDMARK i l x y         n11 n12 n22
// Poses and landmarks share one numbering; a landmark row belongs to the pose before it.
//
// The n are the upper triangle of a covariance. Odometry has (1e-4, 4e-6, 4e-6) on its diagonal: as
// a covariance 1 cm, 2 mm, 2 mrad for a step of half a metre; as information or its square root a
// sigma of 100 m or more, which is absurd. GTSAM's reader takes odometry rows of this shape as a
// covariance too. Landmarks have 0.4 m2, a sigma of 0.63 m; what poses close to each other see of
// one landmark differs by .15 m, so the number is cautious, and 1.6 m (information) would be more
// so. (GTSAM takes 0.4 as the variance of the range and a tenth as that of the bearing; here both
// follow from the Cartesian covariance to first order.)

#include <cmath>

#include <Eigen/LU>

#include <libslam/io/arc_motion.hpp>
#include <libslam/io/importers/victoria_park.hpp>

namespace libslam {
namespace {

constexpr double kPeriod =
    0.2;  ///< [s] nominal: the file has no times, the laser gave 4.7 scans per second

void read_odometry_row(const TextReader& row, ImportedLog& log) {
  ImportedOdometry reading;
  reading.time = log.odometry.back().time + kPeriod;
  reading.dt = kPeriod;
  reading.has_velocity = false;
  reading.arc = arc_of_increment({row.number(3), row.number(4), row.number(5)});
  Eigen::Matrix3d cov;
  cov << row.number(6), row.number(7), row.number(8),  //
      row.number(7), row.number(9), row.number(10),    //
      row.number(8), row.number(10), row.number(11);
  if (!(cov.diagonal().array() > 0.0).all()) row.reject("covariance is not positive");
  reading.cov_increment = cov;
  log.odometry.push_back(reading);
}

void read_landmark_row(const TextReader& row, ImportedLog& log) {
  const Eigen::Vector2d p(row.number(3), row.number(4));
  const double range = p.norm();
  if (!(range > 0.0)) row.reject("landmark at the pose itself");
  Eigen::Matrix2d cov, to_polar;
  cov << row.number(5), row.number(6), row.number(6), row.number(7);
  to_polar << p.x() / range, p.y() / range, -p.y() / (range * range), p.x() / (range * range);
  if (!(cov.determinant() > 0.0)) row.reject("covariance is not positive");
  log.add_sighting(row, log.odometry.back().time,
                   {row.integer(2), range, std::atan2(p.y(), p.x()),
                    Eigen::Matrix2d(to_polar * cov * to_polar.transpose())});
}

}  // namespace

ImportedLog import_victoria_park_isam(const std::string& file) {
  ImportedLog log;
  log.scenario = "Victoria Park, relative form of iSAM";
  log.as_pairs = true;
  log.remarks["times"] = "nominal, 0.2 s apart: the source has none";
  log.remarks["association"] = "known";
  log.odometry.push_back({});
  log.odometry.back().has_velocity = false;
  std::int64_t pose = 0;
  for (TextReader row(file); row.next();) {
    if (row.integer(1) != pose) row.reject("expected a row of pose " + std::to_string(pose));
    if (row.word(0) == "ODOMETRY") {
      read_odometry_row(row, log);
      pose = row.integer(2);
    } else if (row.word(0) == "LANDMARK") {
      read_landmark_row(row, log);
    } else {
      row.reject("expected ODOMETRY or LANDMARK, found '" + std::string(row.word(0).substr(0, 40)) +
                 "'");
    }
  }
  return log;
}

}  // namespace libslam
