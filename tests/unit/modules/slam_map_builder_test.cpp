// Everything here drives the builders through mrpt::slam::CMetricMapBuilder alone.

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/img/CImage.h>
#include <mrpt/maps/CBeaconMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/slam/CMetricMapBuilderICP.h>

#include <libslam/data/step_record.hpp>
#include <libslam/modules/slam_map_builder.hpp>
#include <libslam/pipeline/pipeline.hpp>

#include "map_builder_run.hpp"
#include "support/config_error_message.hpp"
#include "support/temporary_directory.hpp"

namespace libslam {
namespace {

using mrpt::slam::CMetricMapBuilder;
using test::demo_parameters;
using test::kDemo;
using test::pose_of;
using test::read_log;
using test::run;

const std::string kLaserLog =
    "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";

class DemoMap : public ::testing::Test {
 protected:
  DemoMap() {
    builder_.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    builder_.slam_options.parameters = demo_parameters();
  }
  std::shared_ptr<mrpt::maps::CBeaconMap> landmarks() const {
    return builder_.getCurrentlyBuiltMetricMap()->mapByClass<mrpt::maps::CBeaconMap>();
  }
  mrpt::maps::CSimpleMap key_frames() const {
    mrpt::maps::CSimpleMap map;
    builder_.getCurrentlyBuiltMap(map);
    return map;
  }

  SlamMapBuilder builder_;
  const std::vector<LogStep> steps_ = read_log(kDemo);
};

TEST_F(DemoMap, HasThePathOfThePipeline) {
  const auto path = run(builder_, steps_);
  Pipeline pipeline(demo_parameters());
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const StepRecord record = pipeline.process(steps_[i]);
    ASSERT_EQ(path[i].mean.x(), record.pose[0]) << i;
    ASSERT_EQ(path[i].mean.y(), record.pose[1]) << i;
    ASSERT_NEAR(path[i].mean.yaw(), record.pose[2], 1e-15) << i;
    ASSERT_EQ(path[i].cov(0, 1), record.cov(0, 1)) << i;
    ASSERT_EQ(path[i].cov(3, 0), record.cov(2, 0)) << i;
  }
  ASSERT_EQ(path.size(), 250U);
  EXPECT_EQ(path.back().cov(2, 2), 0.0);
}

TEST_F(DemoMap, ShowsItsLandmarksAsBeacons) {
  run(builder_, steps_);
  Pipeline pipeline(demo_parameters());
  for (const LogStep& step : steps_) pipeline.process(step);
  const auto expected = pipeline.filter().landmarks();
  const auto shown = landmarks();
  ASSERT_TRUE(shown);
  ASSERT_EQ(shown->size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const mrpt::maps::CBeacon& beacon = shown->get(i);
    EXPECT_EQ(beacon.m_ID, expected[i].id);
    EXPECT_EQ(beacon.m_locationGauss.mean.x(), expected[i].mean[0]);
    EXPECT_EQ(beacon.m_locationGauss.cov(0, 1), expected[i].cov(0, 1));
  }
  mrpt::opengl::CSetOfObjects drawn;
  builder_.getCurrentlyBuiltMetricMap()->getVisualizationInto(drawn);
  EXPECT_GT(drawn.end() - drawn.begin(), 0);
}

TEST_F(DemoMap, KeepsFramesByDistanceAndByTurn) {
  const auto path = run(builder_, steps_);
  const mrpt::maps::CSimpleMap map = key_frames();
  EXPECT_EQ(map.size(), builder_.getCurrentlyBuiltMapSize());
  ASSERT_GT(map.size(), 3U);
  ASSERT_LT(map.size(), path.size() / 2);
  for (std::size_t i = 1; i < map.size(); ++i) {
    const auto moved =
        map.getAsPair(i).pose->getMeanVal() - map.getAsPair(i - 1).pose->getMeanVal();
    EXPECT_TRUE(moved.norm() >= 1.0 || std::abs(moved.yaw()) >= mrpt::DEG2RAD(30.0)) << i;
  }
}

TEST_F(DemoMap, KeepsEveryFrameOnDemand) {
  builder_.options.debugForceInsertion = true;
  run(builder_, steps_);
  EXPECT_EQ(builder_.getCurrentlyBuiltMapSize(), steps_.size());
  builder_.options.debugForceInsertion = false;
  builder_.options.alwaysInsertByClass.insert(CLASS_ID(mrpt::obs::CObservationBearingRange));
  builder_.clear();
  EXPECT_EQ(builder_.getCurrentlyBuiltMapSize(), 0U);
  run(builder_, steps_);
  EXPECT_EQ(builder_.getCurrentlyBuiltMapSize(), steps_.size());
}

TEST_F(DemoMap, ClearStartsAnew) {
  const auto first = run(builder_, steps_);
  builder_.clear();
  EXPECT_EQ(builder_.getCurrentlyBuiltMapSize(), 0U);
  EXPECT_EQ(pose_of(builder_).mean.norm(), 0.0);
  EXPECT_TRUE(pose_of(builder_).cov.asEigen().isZero(0.0));
  EXPECT_EQ(landmarks()->size(), 0U);
  const auto second = run(builder_, steps_);
  EXPECT_EQ(first.back().mean.x(), second.back().mean.x());
}

TEST_F(DemoMap, IsDrawnIntoAPicture) {
  const test::TemporaryDirectory directory;
  const std::string file = (directory.path() / "map.png").string();
  run(builder_, steps_);
  builder_.saveCurrentEstimationToImage(file);
  mrpt::img::CImage image;
  ASSERT_TRUE(image.loadFromFile(file));
  EXPECT_EQ(std::max(image.getWidth(), image.getHeight()), 1000U);
  int blue = 0, red = 0;
  for (unsigned y = 0; y < image.getHeight(); ++y)
    for (unsigned x = 0; x < image.getWidth(); ++x) {
      const std::uint8_t* bgr = image.ptr<std::uint8_t>(x, y);
      blue += bgr[0] == 255 && bgr[1] == 0 && bgr[2] == 0;
      red += bgr[0] == 0 && bgr[1] == 0 && bgr[2] == 255;
    }
  EXPECT_GT(blue, 70 * 4);  // 70 landmarks, each a few pixels at least
  EXPECT_GT(red, 100);
  EXPECT_THROW(builder_.saveCurrentEstimationToImage("/no/such/folder/map.png"),
               std::runtime_error);
}

// The builder says what it is asked while another thread feeds it; tsan looks on.
TEST_F(DemoMap, MayBeAskedFromAnotherThread) {
  std::atomic<bool> done{false};
  std::thread reader([&] {
    while (!done) {
      EXPECT_TRUE(pose_of(builder_).mean.norm() < 100.0);
      EXPECT_LE(key_frames().size(), steps_.size());
      builder_.getCurrentlyBuiltMapSize();
    }
  });
  const auto path = run(builder_, steps_);
  done = true;
  reader.join();
  EXPECT_EQ(path.size(), steps_.size());
}

TEST_F(DemoMap, LeavesOutAMovementThatCannotBeUsed) {
  std::vector<LogStep> steps = read_log(kDemo, 20);
  for (std::size_t i = 10; i < 12; ++i) {
    auto action = mrpt::obs::CActionCollection::Create();
    mrpt::obs::CActionRobotMovement3D flight;
    flight.poseChange.mean = mrpt::poses::CPose3D(0.1, 0.0, 0.5, 0.0, 0.2, 0.0);
    action->insert(flight);
    steps[i].action = action;
  }
  EXPECT_EQ(run(builder_, steps).size(), 20U);
  builder_.slam_options.parameters.input.policy = "strict";
  builder_.clear();
  EXPECT_THROW(run(builder_, steps), std::runtime_error);
}

// The same program, MRPT's own builder and ours, on a log of laser scans: ours sees no landmarks
// there and drives by odometry, but what comes out has the same form.
TEST(SlamMapBuilder, MakesOfALaserLogWhatMrptsBuilderMakes) {
  const std::vector<LogStep> steps = read_log(kLaserLog, 300);
  ASSERT_GT(steps.size(), 100U);
  const mrpt::config::CConfigFileMemory ini(
      std::string("[MappingApplication]\ninsertionLinDistance = 0.5\ninsertionAngDistance = 20\n"
                  "occupancyGrid_count = 1\npointsMap_count = 1\n"
                  "[MappingApplication_occupancyGrid_00_creationOpts]\nresolution = 0.1\n"));
  SlamMapBuilder ours;
  ours.loadOptions(ini);
  mrpt::slam::CMetricMapBuilderICP stock;
  stock.setMinLoggingLevel(mrpt::system::LVL_ERROR);
  stock.ICP_options.loadFromConfigFile(ini, "MappingApplication");

  struct Shape {
    std::size_t path, key_frames, free_cells;
    double span;
    int dimensions;
  };
  const auto shape_of = [&](CMetricMapBuilder& builder) {
    builder.initialize();
    const auto path = run(builder, steps);
    mrpt::maps::CSimpleMap map;
    builder.getCurrentlyBuiltMap(map);
    EXPECT_EQ(map.size(), builder.getCurrentlyBuiltMapSize());
    for (const auto& [pose, frame] : map) EXPECT_FALSE(frame->empty());
    const auto* metric = builder.getCurrentlyBuiltMetricMap();
    const auto grid = metric->mapByClass<mrpt::maps::COccupancyGridMap2D>();
    const auto points = metric->mapByClass<mrpt::maps::CSimplePointsMap>();
    EXPECT_GT(points->size(), 500U);
    std::size_t free = 0;
    for (unsigned y = 0; y < grid->getSizeY(); ++y)
      for (unsigned x = 0; x < grid->getSizeX(); ++x)
        free += grid->getCell(static_cast<int>(x), static_cast<int>(y)) > 0.6F;
    return Shape{path.size(), map.size(), free, path.back().mean.norm(), 0};
  };
  const Shape own = shape_of(ours), reference = shape_of(stock);
  EXPECT_EQ(own.path, reference.path);
  // Odometry against matched scans: the same drive within a third.
  EXPECT_NEAR(static_cast<double>(own.key_frames), static_cast<double>(reference.key_frames),
              0.33 * static_cast<double>(reference.key_frames));
  EXPECT_NEAR(static_cast<double>(own.free_cells), static_cast<double>(reference.free_cells),
              0.33 * static_cast<double>(reference.free_cells));
}

TEST(SlamMapBuilderOptions, ComeFromAnIniFile) {
  SlamMapBuilder builder;
  builder.loadOptions(mrpt::config::CConfigFileMemory(
      std::string("[MappingApplication]\ninsertionLinDistance = 2\ninsertionAngDistance = 45\n"
                  "enableMapUpdating = false\nalwaysInsertByClass = CObservationBearingRange\n"
                  "verbosity_level = ERROR\npointsMap_count = 1\n"
                  "[libslam.motion]\nmodel = differential\n"
                  "[calibration.scale_left]\nenabled = true\n"
                  "[calibration]\nscale_right.enabled = true\n")));
  EXPECT_EQ(builder.slam_options.insertionLinDistance, 2.0);
  EXPECT_NEAR(builder.slam_options.insertionAngDistance, 0.7853981634, 1e-9);
  EXPECT_EQ(builder.slam_options.mapInitializers.size(), 1U);
  EXPECT_FALSE(builder.options.enableMapUpdating);
  EXPECT_TRUE(
      builder.options.alwaysInsertByClass.contains(CLASS_ID(mrpt::obs::CObservationBearingRange)));
  EXPECT_EQ(builder.getMinLoggingLevel(), mrpt::system::LVL_ERROR);
  builder.initialize();
  const auto calibration = builder.getCurrentCalibration();
  ASSERT_EQ(calibration.size(), 2U);
  EXPECT_EQ(calibration[1].name, "scale_right");
  std::ostringstream dump;
  builder.slam_options.dumpToTextStream(dump);
  EXPECT_NE(dump.str().find("libslam.calibration.scale_left.enabled = true\n"), std::string::npos);
}

TEST(SlamMapBuilderOptions, BadOnesAreNamed) {
  const auto message = [](const std::string& text) {
    return test::config_error_message([&] {
      SlamMapBuilder builder;
      builder.loadOptions(mrpt::config::CConfigFileMemory(text));
      builder.initialize();
    });
  };
  EXPECT_EQ(message("[calibration.scale_lft]\nenabled = true\n"),
            "[calibration.scale_lft] enabled: unknown key 'calibration.scale_lft.enabled'; nearest "
            "valid key: calibration.scale_left.enabled");
  EXPECT_NE(message("[calibration]\nscale_left.enabled = true\n"
                    "[libslam.calibration.scale_left]\nenabled = true\n")
                .find("is set under another name as well"),
            std::string::npos);
  EXPECT_NE(message("[calibration.scale_left]\nenabled = true\n").find("motion.model"),
            std::string::npos);
}

}  // namespace
}  // namespace libslam
