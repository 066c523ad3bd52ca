#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <libslam/io/importers/lost_in_the_woods.hpp>
#include <libslam/io/importers/mrclam.hpp>
#include <libslam/io/importers/victoria_park.hpp>

#include "data_directory.hpp"
#include "import_round_trip.hpp"

namespace libslam {
namespace {

using namespace libslam::test;
using mrpt::obs::CObservationBearingRange;
using mrpt::poses::CPose2D;

using Importer = ImportTest;

/// Range and bearing residuals of all sightings at the true poses nearest in time (within
/// `window`).
struct Residuals {
  std::vector<double> range, bearing;
};

Residuals residuals_at_truth(const ImportedLog& log, double window) {
  Residuals out;
  const auto& path = log.truth.path;
  std::map<std::int64_t, Eigen::Vector2d> map;
  for (const auto& l : log.truth.landmarks) map[l.id] = l.position;
  for (const auto& scan : log.scans) {
    const auto after = std::lower_bound(path.times.begin(), path.times.end(), scan.time - window);
    if (after == path.times.end() || *after > scan.time + window) continue;
    const auto& p = path.poses[static_cast<std::size_t>(after - path.times.begin())];
    const CPose2D sensor = pose(p) + pose(log.T_robot_sensor);
    for (const auto& s : scan.sightings) {
      const Eigen::Vector2d d = map.at(s.id) - Eigen::Vector2d(sensor.x(), sensor.y());
      out.range.push_back(s.range - d.norm());
      out.bearing.push_back(
          std::remainder(s.bearing - (std::atan2(d.y(), d.x()) - sensor.phi()), 2 * M_PI));
    }
  }
  return out;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

double deviation(const std::vector<double>& values) {
  double sum = 0.0, square = 0.0;
  for (const double v : values) sum += v, square += v * v;
  const auto n = static_cast<double>(values.size());
  return std::sqrt(square / n - sum * sum / n / n);
}

TEST_F(Importer, LostInTheWoods) {
  const std::string data = data_set("utias_lost_in_the_woods");
  if (data.empty()) GTEST_SKIP() << "data set utias_lost_in_the_woods is not there";
  const ImportedLog log = import_lost_in_the_woods(data);
  const Played played = round_trip(log);
  EXPECT_EQ(played.sightings, 61086U);
  EXPECT_EQ(played.ids.size(), 17U);
  EXPECT_EQ(played.truth.landmarks.size(), 17U);
  EXPECT_EQ(played.truth.path.poses.size(), 12278U);
  // Computed independently with arcs: 2.8026 m and 4.6236 m (2.83 and 4.64 with Euler steps).
  const auto errors = path_errors(played, 0.01);
  EXPECT_NEAR(rms(errors), 2.8026, 0.001);
  EXPECT_NEAR(errors.back(), 4.6236, 0.001);
  // The data set's own figures: range 0.000 +- 0.033 m, bearing 0.003 +- 0.026 rad.
  const Residuals r = residuals_at_truth(log, 0.01);
  EXPECT_NEAR(deviation(r.range), 0.033, 0.002);
  EXPECT_NEAR(deviation(r.bearing), 0.026, 0.002);
}

TEST_F(Importer, LostInTheWoodsInputMovesToTheNextRow) {
  const std::string data = data_set("utias_lost_in_the_woods");
  if (data.empty()) GTEST_SKIP() << "data set utias_lost_in_the_woods is not there";
  const ImportedLog log = import_lost_in_the_woods(data);
  const auto& path = log.truth.path;
  double used = 0.0, shifted = 0.0;
  for (std::size_t k = 0, i = 0; k + 2 < log.odometry.size(); ++k) {
    while (i + 1 < path.times.size() && path.times[i] < log.odometry[k].time - 0.01) ++i;
    if (std::abs(path.times[i] - log.odometry[k].time) > 0.01 ||
        path.times[i + 1] - path.times[i] > 0.11)
      continue;
    const double turn = std::remainder(path.poses[i + 1].z() - path.poses[i].z(), 2 * M_PI);
    used += std::pow(turn - log.odometry[k + 1].arc.z(), 2);
    shifted += std::pow(turn - log.odometry[k + 2].arc.z(), 2);
  }
  EXPECT_LT(used, 0.7 * shifted);
}

TEST_F(Importer, MrclamRobotOne) {
  const std::string data = data_set("mrclam/MRCLAM_Dataset6");
  if (data.empty()) GTEST_SKIP() << "data set mrclam is not there";
  const ImportedLog log = import_mrclam(data, 1);
  const Played played = round_trip(log);
  EXPECT_EQ(played.ids.size(), 15U);
  EXPECT_EQ(*played.ids.begin(), 6);
  EXPECT_EQ(*played.ids.rbegin(), 20);
  // The data set's own figures over its five robots.
  const double error = rms(path_errors(played, 0.011));
  EXPECT_GT(error, 1.8);
  EXPECT_LT(error, 4.2);
  const Residuals r = residuals_at_truth(log, 0.011);
  EXPECT_GT(median(r.range), -0.02);
  EXPECT_LT(median(r.range), 0.07);
  EXPECT_LT(std::abs(median(r.bearing)), 0.03);
}

TEST_F(Importer, MrclamWithoutTruthOfThePathAndWithARowOutOfOrder) {
  const std::string data = data_set("mrclam/MRCLAM_Dataset9");
  if (data.empty()) GTEST_SKIP() << "data set mrclam is not there";
  const Played played = round_trip(import_mrclam(data, 1));
  EXPECT_TRUE(played.truth.path.poses.empty());
  EXPECT_EQ(played.truth.landmarks.size(), 15U);
  EXPECT_GT(played.sightings, 1000U);
}

TEST_F(Importer, VictoriaParkTreesAndBothSteeringCalibrations) {
  const std::string data = data_set("victoria_park");
  if (data.empty()) GTEST_SKIP() << "data set victoria_park is not there";
  VictoriaParkOptions options;
  const ImportedLog log = import_victoria_park(data, options);
  const Played played = round_trip(log);
  EXPECT_EQ(played.sightings, 52974U);
  EXPECT_EQ(played.ids, std::set<int>{-1});
  EXPECT_EQ(played.truth.path.poses.size(), 948U);
  EXPECT_FALSE(played.truth.path.has_heading);
  double driven = 0.0;
  for (const auto& o : log.odometry) driven += o.arc.x();
  EXPECT_NEAR(driven, 4027.0, 50.0);  // "about 4.0 km", integral of the encoder speed
  options.steering = VictoriaParkOptions::Steering::kDrs;
  const ImportedLog drs = import_victoria_park(data, options);
  // Steering behind each reading of the two versions, least squares: DRS = 1.0592 aa3 + 0.0026 rad.
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  std::size_t j = 0;
  for (const auto& o : log.odometry) {
    while (j + 1 < drs.odometry.size() && drs.odometry[j].time < o.time - 1e-6) ++j;
    if (std::abs(drs.odometry[j].time - o.time) > 1e-6 || o.arc.x() < 0.02) continue;
    const double x = std::atan(2.83 * o.arc.z() / o.arc.x());
    const double y = std::atan(2.83 * drs.odometry[j].arc.z() / drs.odometry[j].arc.x());
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  EXPECT_NEAR(slope, 1.0592, 5e-4);
  EXPECT_NEAR((sy - slope * sx) / n, 0.0026, 2e-4);
}

TEST_F(Importer, VictoriaParkFalsifiedReadings) {
  const std::string data = data_set("victoria_park");
  if (data.empty()) GTEST_SKIP() << "data set victoria_park is not there";
  VictoriaParkOptions options;
  const ImportedLog honest = import_victoria_park(data, options);
  options.distortion = {1.03, 0.97, 0.01};
  const ImportedLog falsified = import_victoria_park(data, options);
  ASSERT_EQ(honest.odometry.size(), falsified.odometry.size());
  const auto encoder = [](const ImportedOdometry& o) { return o.arc.x() - 0.76 * o.arc.z(); };
  for (std::size_t i = 0; i < honest.odometry.size(); ++i) {
    const auto &a = honest.odometry[i], &b = falsified.odometry[i];
    ASSERT_NEAR(encoder(b), 1.03 * encoder(a), 1e-12);
    if (a.arc.x() <= 0.01) continue;  // the steering does not show at rest
    ASSERT_NEAR(std::atan(2.83 * b.arc.z() / b.arc.x()),
                0.97 * std::atan(2.83 * a.arc.z() / a.arc.x()) + 0.01, 1e-12);
  }
}

TEST_F(Importer, VictoriaParkKnownAssociation) {
  const std::string data = data_set("victoria_park");
  if (data.empty()) GTEST_SKIP() << "data set victoria_park is not there";
  VictoriaParkOptions options;
  options.association = VictoriaParkOptions::Association::kKnown;
  const Played played = round_trip(import_victoria_park(data, options));
  EXPECT_EQ(played.sightings, 46860U);
  EXPECT_EQ(played.ids.size(), 299U);
}

TEST_F(Importer, VictoriaParkIsamAsPairsWithCovariances) {
  const std::string data = data_set("victoria_park");
  if (data.empty()) GTEST_SKIP() << "data set victoria_park is not there";
  VictoriaParkOptions options;
  options.association = VictoriaParkOptions::Association::kIsam;
  const ImportedLog log = import_victoria_park(data, options);
  const Played played = round_trip(log);
  ASSERT_EQ(played.steps.size(), 6969U);
  EXPECT_EQ(played.sightings, 3640U);
  EXPECT_EQ(played.ids.size(), 151U);
  EXPECT_TRUE(played.steps[1].has_motion_covariance);
  // First step of the file: dx 0.000985144 with variance 1e-4.
  const auto first = motion_of(played.steps[1]);
  EXPECT_NEAR(first->poseChange->getMeanVal().x(), 0.000985144, 1e-15);
  EXPECT_EQ(first->poseChange->getCovariance()(0, 0), 1e-4);
  // First sighting: (11.5387, -3.2007) with 0.4 m2 in x and y, so 0.4 along the range and 0.4 / r2
  // across.
  const auto seen = played.steps[4].frame->getObservationByClass<CObservationBearingRange>();
  ASSERT_EQ(seen->sensedData.size(), 1U);
  EXPECT_TRUE(seen->validCovariances);
  const double range = std::hypot(11.5387, -3.2007);
  EXPECT_NEAR(seen->sensedData[0].range, range, 1e-6);  // stored as float
  EXPECT_NEAR(seen->sensedData[0].yaw, std::atan2(-3.2007, 11.5387), 1e-7);
  EXPECT_NEAR(seen->sensedData[0].covariance(0, 0), 0.4, 1e-12);
  EXPECT_NEAR(seen->sensedData[0].covariance(1, 1), 0.4 / (range * range), 1e-12);
}

}  // namespace
}  // namespace libslam
