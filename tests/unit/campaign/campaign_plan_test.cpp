#include <algorithm>
#include <filesystem>
#include <support/config_error_message.hpp>

#include <libslam/campaign/campaign_plan.hpp>
#include <libslam/io/input_error.hpp>

#include "campaign_fixture.hpp"

namespace libslam {
namespace {

using namespace test;

const Parameters& filter_of(const CampaignPlan& plan, std::size_t variant, std::size_t point = 0) {
  return plan.points.at(point).variants.at(variant).parameters;
}

std::string message_of(const std::string& text, const std::vector<std::string>& settings = {}) {
  return config_error_message([&] { load_text(text, settings); });
}

void expect_message(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(CampaignPlan, FilterKnowsTheNominalVehicleAndNotTheTruth) {
  const CampaignPlan plan = load_text(kSmallScenario + R"(
  log: {odometry: velocities}
  range_bearing: {sigma_range: 0.3, sigma_bearing_deg: 1.5}
)");
  ASSERT_EQ(plan.points.size(), 1U);
  ASSERT_EQ(plan.points[0].variants.size(), 1U);
  const Parameters& filter = filter_of(plan, 0);
  EXPECT_EQ(filter.motion.model, "ackermann");
  EXPECT_EQ(filter.motion.wheelbase, 4.0);
  EXPECT_EQ(filter.input.odometry, "velocities");
  EXPECT_EQ(filter.measurement.sigma_range, 0.3);
  EXPECT_EQ(filter.measurement.sigma_bearing_deg, 1.5);
  EXPECT_FALSE(filter.calibration.scale_left.enabled);
  EXPECT_EQ(plan.points[0].scenario.truth.scale_left, 1.05);
}

TEST(CampaignPlan, LaterLayersOfTheFilterWin) {
  const CampaignPlan plan = load_text(kSmallScenario + R"(
filter: {measurement: {sigma_range: 1, sigma_bearing_deg: 1}}
variants:
  a:
  b: {measurement: {sigma_range: 4}}
grid:
  filter.measurement.sigma_range: [2, 3]
)",
                                      {"filter.measurement.sigma_bearing_deg=5"});
  ASSERT_EQ(plan.points.size(), 2U);
  EXPECT_EQ(filter_of(plan, 0, 0).measurement.sigma_range, 2.0);
  EXPECT_EQ(filter_of(plan, 0, 1).measurement.sigma_range, 3.0);
  EXPECT_EQ(filter_of(plan, 1, 1).measurement.sigma_range, 4.0);
  EXPECT_EQ(filter_of(plan, 1, 0).measurement.sigma_bearing_deg, 5.0);
}

TEST(CampaignPlan, GridIsEveryCombinationAndJoinedKeysChangeTogether) {
  const CampaignPlan plan = load_text(kSmallScenario + R"(
grid:
  scenario.truth.scale_left, scenario.truth.scale_right: [1.0, 1.02, 1.1]
  filter.measurement.sigma_range: [0.2, 0.4]
)");
  ASSERT_EQ(plan.points.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    const double scale = std::array{1.0, 1.02, 1.1}[i / 2];
    EXPECT_EQ(plan.points[i].scenario.truth.scale_left, scale);
    EXPECT_EQ(plan.points[i].scenario.truth.scale_right, scale);
    EXPECT_EQ(filter_of(plan, 0, i).measurement.sigma_range, i % 2 == 0 ? 0.2 : 0.4);
    ASSERT_EQ(plan.points[i].settings.size(), 3U);
    EXPECT_EQ(plan.points[i].settings[0].first, "scenario.truth.scale_left");
  }
}

TEST(CampaignPlan, TasksAreNumberedByPointBatchAndRunAndShareSeedsAcrossPoints) {
  const CampaignPlan plan = load_text(
      kSmallScenario +
      "grid: {scenario.drive.speed: [1, 2]}\ncampaign: {runs: 3, batches: 2, seed: 10}\n");
  ASSERT_EQ(plan.tasks(), 12U);
  const CampaignTask task = task_of(plan, 10);
  EXPECT_EQ(task.point, 1U);
  EXPECT_EQ(task.batch, 1);
  EXPECT_EQ(task.run, 1);
  EXPECT_EQ(task.seed, 14U);
  EXPECT_EQ(task_of(plan, 4).seed, 14U);
}

TEST(CampaignPlan, FilesStandBesideTheCampaign) {
  const TemporaryDirectory directory;
  directory.write("worlds/l.csv", "id,x,y\n1,5,0\n");
  directory.write("worlds/w.csv", "id,x,y\n1,20,0\n");
  directory.write("sim.yaml",
                  "world: {generator: file, landmarks_file: worlds/l.csv, way_points_file: "
                  "worlds/w.csv}\n");
  directory.write("filter.yaml", "measurement: {sigma_range: 0.7}\n");
  const auto file = directory.write("mc.yaml", "scenario: sim.yaml\nfilter: filter.yaml\n");
  const CampaignPlan plan = load_campaign(file);
  EXPECT_EQ(filter_of(plan, 0).measurement.sigma_range, 0.7);
  EXPECT_EQ(plan.points[0].scenario.world.landmarks_file,
            (directory.path() / "worlds/l.csv").string());
  const auto swept = directory.write(
      "grid.yaml", "scenario: sim.yaml\ngrid: {scenario.world.landmarks_file: [worlds/l.csv]}\n");
  EXPECT_EQ(load_campaign(swept).points[0].scenario.world.landmarks_file,
            (directory.path() / "worlds/l.csv").string());
}

TEST(CampaignPlan, WorldFilesAreCheckedBeforeTheFirstRunInAllPoints) {
  const TemporaryDirectory directory;
  directory.write("l.csv", "id,x,y\n1,5,0\n");
  directory.write("w.csv", "id,x,y\n1,20,0\n");
  const auto file = directory.write(
      "mc.yaml",
      "scenario: {world: {generator: file, landmarks_file: l.csv, way_points_file: w.csv}}\n"
      "grid: {scenario.world.landmarks_file: [l.csv, none.csv]}\n");
  try {
    load_campaign(file);
    ADD_FAILURE() << "none.csv was not missed";
  } catch (const InputError& error) {
    expect_message(error.what(), "none.csv: no such file");
  }
}

TEST(CampaignPlan, IdentityFollowsTheContentOfWorldFilesAndEverySetting) {
  const TemporaryDirectory directory;
  directory.write("l.csv", "id,x,y\n1,5,0\n");
  directory.write("w.csv", "id,x,y\n1,20,0\n");
  const auto file = directory.write(
      "mc.yaml",
      "scenario: {world: {generator: file, landmarks_file: l.csv, way_points_file: w.csv}}\n");
  const std::string identity = identify(load_campaign(file));
  EXPECT_EQ(identity.size(), 64U);
  EXPECT_EQ(identify(load_campaign(file)), identity);
  EXPECT_NE(identify(load_campaign(file, {"campaign.seed=2"})), identity);
  EXPECT_NE(identify(load_campaign(file, {"filter.measurement.sigma_range=1"})), identity);
  directory.write("moved/l.csv", "id,x,y\n1,5,0\n");
  directory.write("moved/w.csv", "id,x,y\n1,20,0\n");
  std::filesystem::copy(file, directory.path() / "moved/mc.yaml");
  EXPECT_EQ(identify(load_campaign(directory.path() / "moved/mc.yaml")), identity);
  directory.write("l.csv", "id,x,y\n1,5,1\n");
  EXPECT_NE(identify(load_campaign(file)), identity);
}

TEST(CampaignPlan, MistakesAreNamedWithTheirPlace) {
  expect_message(message_of("champaign: {runs: 3}\n"), "mc.yaml:1:1: unknown section");
  expect_message(message_of("campaign:\n  rnus: 3\n"), "mc.yaml:2:3");
  expect_message(message_of("campaign: {runs: 0}\n"), "runs");
  expect_message(message_of("scenario:\n  drive:\n    sped: 3\n"), "mc.yaml:3:5");
  expect_message(message_of("scenario: [1]\n"), "mc.yaml:1:11: a file name or a mapping");
  expect_message(message_of("scenario: none.yaml\n"), "none.yaml: no such file");
  expect_message(message_of("variants:\n  a b: {}\n"), "mc.yaml:2:3: a variant is named by");
  expect_message(message_of("variants:\n  a: {engine: gtsam}\n"), "mc.yaml:2:15: engine");
  expect_message(message_of("variants:\n  a: {filter: {eror_frame: standard}}\n"), "mc.yaml:2:16");
  expect_message(message_of("grid:\n  truth.scale_left: [1]\n"), "mc.yaml:2:3: grid:");
  expect_message(message_of("grid:\n  scenario.: [1]\n"), "must begin with scenario. or filter.");
  expect_message(message_of("grid:\n  scenario.drive.laps,: [1]\n"), "must begin with");
  expect_message(message_of("grid:\n  scenario.drive.laps: 1\n"), "a list of values");
  expect_message(message_of("grid:\n  scenario.drive.laps: []\n"), "a list of values");
  expect_message(message_of("grid:\n  scenario.drive.laps: [[1]]\n"), "mc.yaml:2:25");
  expect_message(message_of("grid:\n  scenario.drive.lapz: [1]\n"), "scenario.drive.lapz = 1");
  expect_message(message_of("grid:\n  scenario.seed: [1, 2]\n"), "no effect");
  expect_message(message_of("campaign: {reference: best}\nvariants: {a: {}}\n"), "'best'");
  expect_message(message_of("", {"scenario.seed=3"}), "no effect");
  expect_message(message_of("", {"runs=3"}), "must begin with campaign.");
  expect_message(message_of("", {"filter.no.such=3"}), "no.such");
}

TEST(CampaignPlan, KeyInTwoAxesIsRefused) {
  expect_message(message_of("grid:\n  scenario.drive.laps: [1]\n"
                            "  scenario.drive.speed, scenario.drive.laps: [2]\n"),
                 "mc.yaml:3:3: grid: 'scenario.drive.laps' is given twice");
  expect_message(message_of("grid:\n  scenario.drive.laps, scenario.drive.laps: [1]\n"), "twice");
}

TEST(CampaignPlan, UnsoundCombinationsNameTheVariantOrThePoint) {
  const std::string invariant_at_truth = message_of(
      kSmallScenario + "variants:\n  good:\n  wild: {filter: {linearization: at_truth}}\n");
  expect_message(invariant_at_truth, "variant wild");
  const std::string track =
      message_of(kSmallScenario + "grid: {scenario.truth.track_width: [1, 2]}\n");
  expect_message(track, "scenario.truth.track_width = 2");
}

TEST(CampaignPlan, SizesAreLimited) {
  expect_message(message_of("campaign: {runs: 1000000, batches: 2}\n"), "more than 1000000");
  std::string variants = "variants:\n";
  for (int i = 0; i <= 100; ++i) variants += "  v" + std::to_string(i) + ":\n";
  expect_message(message_of(variants), "more than 100 variants");
  std::string values = "[1";
  for (int i = 2; i <= 101; ++i) values += ", " + std::to_string(i);
  values += "]";
  expect_message(message_of(kSmallScenario + "grid:\n  scenario.drive.speed: " + values +
                            "\n  filter.measurement.sigma_range: " + values + "\n"),
                 "more than 10000 points");
}

TEST(CampaignPlan, EffectivePlanHasOneDocumentPerScenarioAndFilter) {
  const CampaignPlan plan =
      load_text(kSmallScenario + kTwoVariants + "grid: {scenario.drive.speed: [1, 2]}\n");
  const std::string yaml = to_yaml(plan);
  std::size_t documents = 1;
  for (std::size_t at = 0; (at = yaml.find("\n---\n", at)) != std::string::npos; ++at) ++documents;
  EXPECT_EQ(documents, 1U + 2U * (1U + 2U));
}

}  // namespace
}  // namespace libslam
