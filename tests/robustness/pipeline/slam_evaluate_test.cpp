// slam-evaluate as a user meets it: tables, formats, exit codes, and the batch optimum.

#include <filesystem>
#include <support/program_run.hpp>

#include <nlohmann/json.hpp>

namespace libslam {
namespace {

using namespace libslam::test;

const std::string kRun = LIBSLAM_SLAM_RUN, kEvaluate = LIBSLAM_SLAM_EVALUATE;
const std::string kConfig = LIBSLAM_CONFIG_DIR "/range_bearing.yaml";

class SlamEvaluate : public ProgramTest {
 protected:
  Outcome evaluate(const std::string& arguments) const { return run(kEvaluate + " " + arguments); }

  /// A run of `log` (default: the demo log with its truth) in the scratch directory.
  std::string make_run(const std::string& name, const std::string& log = kGoodLog,
                       const std::string& options = "") const {
    const Outcome outcome =
        run(kRun + " " + kConfig + " " + log + " --out " + path(name) + " " + options);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return path(name);
  }
  std::string copy_log() const {
    std::filesystem::copy_file(kGoodLog, path("copy.rawlog"));
    return path("copy.rawlog");
  }

  /// Exit code and a single line on stderr that holds `text`.
  void expect_complaint(const Outcome& outcome, int code, const std::string& text) const {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  }
};

TEST_F(SlamEvaluate, AnswersQuestionsAboutItself) {
  EXPECT_EQ(evaluate("--help").code, 0);
  EXPECT_NE(evaluate("--help").out.find("Example"), std::string::npos);
  EXPECT_EQ(evaluate("--version").code, 0);
  EXPECT_EQ(evaluate("").code, 2);
  EXPECT_EQ(evaluate("--no-such-option run").code, 2);
  EXPECT_EQ(evaluate("--json --csv run").code, 2);
  EXPECT_EQ(evaluate("--batch --csv run").code, 2);
  EXPECT_EQ(evaluate("--on-line 5 run").code, 2);  // means nothing without --batch
  EXPECT_EQ(evaluate("--batch --on-line 0 run").code, 2);
}

TEST_F(SlamEvaluate, PrintsTableJsonAndCsvOfTheSameFigures) {
  const std::string run = make_run("demo");
  const auto written = nlohmann::json::parse(read_all(run + "/run.json"))["truth"];
  const Outcome table = evaluate(run);
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_NE(table.out.find("path RMSE raw [m]"), std::string::npos);
  const Outcome json = evaluate("--json " + run);
  EXPECT_EQ(json.code, 0);
  const auto truth = nlohmann::json::parse(json.out)["runs"][0]["truth"];
  EXPECT_EQ(truth["ate_rmse_m"], written["ate_rmse_m"]);
  EXPECT_EQ(truth["map_rmse_m"], written["map_rmse_m"]);
  const Outcome csv = evaluate("--csv " + run);
  EXPECT_EQ(csv.code, 0);
  EXPECT_EQ(csv.out.find("run,ate_rmse_m,"), 0u);
  EXPECT_NE(csv.out.find("\ndemo," + written["ate_rmse_m"].dump() + ","), std::string::npos);
  EXPECT_EQ(evaluate("--quiet " + run).out, "");
}

TEST_F(SlamEvaluate, ComparesWithRelations) {
  const std::string run = make_run("demo");
  std::istringstream rows(read_all(run + "/trajectory.tum"));
  std::string first, line, last;
  for (std::getline(rows, first); std::getline(rows, line);) last = line;
  const std::string times = first.substr(0, first.find(' ')) + " " + last.substr(0, last.find(' '));
  const Outcome table =
      evaluate(run + " --relations " + write("x.relations", times + " 1000 0 0 0 0 0\n"));
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_NE(table.out.find("relations, translation [m]"), std::string::npos) << table.out;
  const Outcome json = evaluate("--json " + run + " --relations " + path("x.relations"));
  const auto relations = nlohmann::json::parse(json.out)["runs"][0]["truth"]["relations"];
  EXPECT_EQ(relations["matched"], 1);
  EXPECT_GT(relations["trans_mean_m"].get<double>(), 900.0);
  for (const char* key : {"trans_std_m", "rot_mean_deg", "rot_std_deg"})
    EXPECT_TRUE(relations.contains(key)) << key;
  expect_complaint(evaluate(run + " --relations " + path("none")), 4, "none: no such file");
  expect_complaint(evaluate(run + " --relations " + write("bad", "1 2 3\n")), 4, "bad:1: ");
  expect_complaint(evaluate(run + " --relations " + write("far", "1 2 0 0 0 0 0 0\n")), 5,
                   "no poses at the times of the relations");
}

TEST_F(SlamEvaluate, TheSmoothedPathStandsBesideTheOneThatWasDriven) {
  const std::string run = make_run("demo", kGoodLog, "--set filter.delayed_pose_distance=2");
  const auto written = nlohmann::json::parse(read_all(run + "/run.json"))["truth"];
  ASSERT_TRUE(written.contains("path_smoothed")) << written;
  EXPECT_EQ(written["path_smoothed"]["poses"], written["poses"]);
  // The log is simulated with the noise of the configuration: what came later helps.
  EXPECT_LT(written["path_smoothed"]["ate_rmse_m"], written["ate_rmse_m"]);
  EXPECT_NE(read_all(run + "/log.txt").find("smoothed path error (RMSE): "), std::string::npos);
  std::istringstream rows(read_all(run + "/trajectory_smoothed.tum"));
  std::string first, line, last;
  for (std::getline(rows, first); std::getline(rows, line);) last = line;
  const std::string times = first.substr(0, first.find(' ')) + " " + last.substr(0, last.find(' '));
  const std::string relations = write("x.relations", times + " 1000 0 0 0 0 0\n");
  const Outcome table = evaluate(run + " --relations " + relations);
  EXPECT_EQ(table.code, 0) << table.err;
  for (const char* row : {"  smoothed, raw [m]", "smoothed relations, translation [m]",
                          "\nrelations, translation [m]"})
    EXPECT_NE(table.out.find(row), std::string::npos) << row << table.out;
  const auto truth = nlohmann::json::parse(evaluate("--json " + run).out)["runs"][0]["truth"];
  EXPECT_NEAR(truth["path_smoothed"]["ate_rmse_m"].get<double>(),
              written["path_smoothed"]["ate_rmse_m"].get<double>(), 1e-8);  // decimals of TUM
}

TEST_F(SlamEvaluate, SaysWhatCannotBeReadOrCompared) {
  expect_complaint(evaluate(path("none")), 4, "none");
  const std::string run = make_run("demo");
  const Outcome both = evaluate(run + " " + path("none"));
  expect_complaint(both, 5, "none");
  EXPECT_NE(both.out.find("demo"), std::string::npos);
  write("broken/run.json", "{\"program\": ");
  expect_complaint(evaluate(path("broken")), 4, "run.json");
  expect_complaint(evaluate(run + " --truth " + path("no.tum")), 4, "no.tum");
  expect_complaint(evaluate(make_run("alone", copy_log())), 5, "--truth");
}

TEST_F(SlamEvaluate, BatchStandsBesideTheFilterAndIsWrittenDown) {
  const std::string run = make_run("demo");
  const Outcome outcome = evaluate("--batch --on-line 4 " + run);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* text :
       {"filter", "batch", "map RMSE raw", "distance:", "chi-square", "at 4 steps"})
    EXPECT_NE(outcome.out.find(text), std::string::npos) << text;
  EXPECT_EQ(outcome.out.find("NOT CONVERGED"), std::string::npos);
  const auto written = nlohmann::json::parse(read_all(run + "/batch.json"));
  EXPECT_EQ(written["run"], "demo");
  EXPECT_EQ(written["distance"]["landmarks"], 70);
  EXPECT_EQ(written["on_line"]["poses"], 4);
  EXPECT_TRUE(written["optimization"]["converged"].get<bool>());
  EXPECT_LT(written["optimization"]["chi_square"], written["optimization"]["chi_square_before"]);
  // The log is simulated with the noise of the configuration: the smoothed path is the better one.
  EXPECT_LT(written["batch"]["truth"]["ate_rmse_m"], written["filter"]["truth"]["ate_rmse_m"]);
  // The replay is the run.
  const auto summary = nlohmann::json::parse(read_all(run + "/run.json"));
  EXPECT_EQ(written["filter"]["truth"]["map_rmse_m"], summary["truth"]["map_rmse_m"]);
  EXPECT_EQ(written["filter"]["truth"]["ate_rmse_m"], summary["truth"]["ate_rmse_m"]);

  auto printed =
      nlohmann::json::parse(evaluate("--batch --on-line 4 --json " + run).out)["runs"][0];
  auto first = written;
  printed.erase("timing");
  first.erase("timing");
  EXPECT_EQ(printed, first);
  EXPECT_EQ(evaluate("--batch --quiet " + run).out, "");
}

TEST_F(SlamEvaluate, BatchNeedsTheLogOfTheRun) {
  const std::string log = copy_log(), run = make_run("run", log);
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 1);
  expect_complaint(evaluate("--batch " + run), 4, "not the log");
  std::filesystem::remove(log);
  expect_complaint(evaluate("--batch " + run), 4, "copy.rawlog");
  EXPECT_FALSE(std::filesystem::exists(run + "/batch.json"));
  const std::string good = make_run("good");
  const Outcome both = evaluate("--batch " + run + " " + good);
  expect_complaint(both, 5, "copy.rawlog");
  EXPECT_NE(both.out.find("chi-square"), std::string::npos);
}

TEST_F(SlamEvaluate, BatchWorksWithoutTruthAndOnAnInterruptedRun) {
  const std::string run = make_run("run", copy_log());
  EXPECT_EQ(evaluate("--batch " + run).code, 0);
  // A run that was stopped after 100 steps is held against the optimum of these; before the first
  // there is no motion, so its pose is the known start.
  auto summary = nlohmann::json::parse(read_all(run + "/run.json"));
  summary["timing"]["steps"] = 100;
  write("run/run.json", summary.dump());
  EXPECT_EQ(evaluate("--batch " + run).code, 0);
  EXPECT_EQ(nlohmann::json::parse(read_all(run + "/batch.json"))["optimization"]["poses"], 99);
}

TEST_F(SlamEvaluate, BatchOfARunWithoutLandmarks) {
  const std::string log = odometry_log(50, [](int, auto&) {});
  const Outcome made = run(kRun + " " + kConfig + " " + log + " --out " + path("run"));
  EXPECT_EQ(made.code, 0) << made.err;
  const Outcome outcome = evaluate("--batch " + path("run"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto written = nlohmann::json::parse(read_all(path("run/batch.json")));
  EXPECT_EQ(written["distance"]["landmarks"], 0);
  EXPECT_LT(written["distance"]["path_max_m"], 1e-9);
}

}  // namespace
}  // namespace libslam
