#include <cmath>
#include <filesystem>

#include <libslam/io/arc_motion.hpp>
#include <libslam/io/importers/csv_log.hpp>
#include <libslam/io/input_error.hpp>

#include "import_round_trip.hpp"

namespace libslam {
namespace {

using namespace libslam::test;
using mrpt::obs::CObservationBearingRange;
using mrpt::poses::CPose2D;

/// A short log of one's own: a circle driven at constant velocity.
class CsvImporter : public ImportTest {
 protected:
  CsvLogOptions options(const std::string& odometry, const std::string& landmarks) {
    CsvLogOptions o;
    o.odometry = directory_.write("odometry.csv", odometry).string();
    o.landmarks = directory_.write("landmarks.csv", landmarks).string();
    return o;
  }
  const std::string landmarks_ =
      "t,id,range,bearing\n0.5,7,2.0,0.1\n0.5,-1,3.0,-0.1\n1,7,1.9,0.2\n";
};

TEST_F(CsvImporter, AllFormsOfOdometryGiveTheSamePath) {
  const double x = std::sin(0.2) * 5.0, y = (1.0 - std::cos(0.2)) * 5.0;
  const std::string poses =
      "t,x,y,phi\n0,0,0,0\n1," + std::to_string(x) + "," + std::to_string(y) + ",0.2\n";
  for (const std::string& text :
       {poses, std::string("t,v,omega\n0,9,9\n1,1,0.2\n"),
        std::string("t,left_ticks,right_ticks\n0,100,200\n1,1050,1250\n")}) {
    const Played played = round_trip(import_csv(options(text, landmarks_)));
    ASSERT_EQ(played.sightings, 3U);
    EXPECT_NEAR(played.poses.back().x(), x, 1e-6) << text;  // std::to_string gives 6 decimals
    EXPECT_NEAR(played.poses.back().y(), y, 1e-6) << text;
    EXPECT_NEAR(played.poses.back().phi(), 0.2, 1e-6) << text;
    EXPECT_EQ(played.ids, (std::set<int>{-1, 7}));
  }
}

TEST_F(CsvImporter, VelocityTimesIntervalIsTheIncrementAlsoWhenFalsified) {
  ImportedLog log = import_csv(options("t,v,omega\n0,0,0\n1,1,0.2\n3,0.5,-0.4\n", landmarks_));
  const auto honest = log.odometry;
  distort_wheels(log, 1.04, 0.98, 0.5);
  for (std::size_t i = 0; i < honest.size(); ++i) {
    const auto left = [](const auto& o) { return o.arc.x() - 0.25 * o.arc.z(); };
    const auto right = [](const auto& o) { return o.arc.x() + 0.25 * o.arc.z(); };
    EXPECT_NEAR(left(log.odometry[i]), 1.04 * left(honest[i]), 1e-15);
    EXPECT_NEAR(right(log.odometry[i]), 0.98 * right(honest[i]), 1e-15);
  }
  for (const LogStep& step : round_trip(log).steps) {
    const auto motion = motion_of(step);
    if (!motion) continue;
    ASSERT_TRUE(motion->hasVelocities);
    const Eigen::Vector3d arc(motion->velocityLocal.vx * step.dt,
                              motion->velocityLocal.vy * step.dt,
                              motion->velocityLocal.omega * step.dt);
    const CPose2D& d = motion->rawOdometryIncrementReading;
    EXPECT_LT((increment_of_arc(arc) - Eigen::Vector3d(d.x(), d.y(), d.phi())).norm(), 1e-12);
  }
}

TEST_F(CsvImporter, SigmasBecomeCovariancesAndIdentitiesCanBeStripped) {
  ImportedLog log =
      import_csv(options("t,v,omega\n0,0,0\n1,1,0\n",
                         "t,id,range,bearing,sigma_range,sigma_bearing\n0.5,7,2.0,0.1,0.2,0.05\n"));
  strip_identities(log);
  const Played played = round_trip(log);
  EXPECT_EQ(played.ids, std::set<int>{-1});
  for (const LogStep& step : played.steps) {
    if (!step.frame) continue;
    const auto seen = step.frame->getObservationByClass<CObservationBearingRange>();
    EXPECT_TRUE(seen->validCovariances);
    EXPECT_NEAR(seen->sensedData[0].covariance(0, 0), 0.04, 1e-15);
    EXPECT_NEAR(seen->sensedData[0].covariance(1, 1), 0.0025, 1e-15);
  }
}

TEST_F(CsvImporter, ErrorsNameFileAndLine) {
  const std::string good = "t,v,omega\n0,0,0\n1,1,0\n";
  const auto error_of = [&](const std::string& odometry,
                            const std::string& landmarks) -> std::string {
    try {
      import_csv(options(odometry, landmarks));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const auto o = (directory_.path() / "odometry.csv").string() + ":";
  const auto l = (directory_.path() / "landmarks.csv").string() + ":";
  EXPECT_EQ(error_of("t,v,omega\n1,0,0\n0,1,0\n", landmarks_), o + "3: time goes backwards");
  EXPECT_EQ(error_of("t,v,omega\n1,0\n", landmarks_),
            o + "2: expected at least 3 columns, found 2");
  EXPECT_EQ(error_of("time,v\n", landmarks_).rfind(o + "1: expected the header", 0), 0U);
  EXPECT_EQ(error_of("t,v,omega\n1,inf,0\n", landmarks_).rfind(o + "2: ", 0), 0U);
  EXPECT_EQ(error_of(good, "t,id,range,bearing\n0,1,-2,0\n"), l + "2: range must be positive");
  EXPECT_EQ(error_of(good, "t,id,range,bearing\n0,9999999999,2,0\n"),
            l + "2: landmark id out of range");
  EXPECT_EQ(error_of("t,left_ticks,right_ticks\n0,3000000000,1\n", landmarks_),
            o + "2: encoder counter beyond 32 bits");
}

TEST_F(CsvImporter, InterruptedWritingLeavesAReadableLogAndOldTruthGoes) {
  directory_.write("x.landmarks.csv", "id,x,y\n1,2,3\n");
  int asked = 0;
  EXPECT_FALSE(
      write_imported_log(import_csv(options("t,v,omega\n0,0,0\n1,1,0\n2,1,0\n", landmarks_)),
                         rawlog(), [&] { return ++asked == 3; }));
  RawlogPlayer player(rawlog(), with_policy("strict"));
  EXPECT_EQ(motion_of(play(player).back())->rawOdometryIncrementReading.x(), 0.5);
  EXPECT_FALSE(std::filesystem::exists(directory_.path() / "x.landmarks.csv"));
}

}  // namespace
}  // namespace libslam
