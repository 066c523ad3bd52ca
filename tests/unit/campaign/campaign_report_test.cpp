#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <libslam/campaign/campaign_report.hpp>
#include <libslam/campaign/campaign_report_data.hpp>
#include <libslam/campaign/campaign_report_table.hpp>

namespace libslam {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Json distribution(double mean) {
  return {{"mean", mean}, {"median", mean}, {"p95", mean}, {"sd", 0.5}};
}

Json run_row(int seed, const std::string& status, double position) {
  Json row = {{"batch", 0}, {"run", seed - 1}, {"seed", seed}, {"status", status}};
  if (status == "done") {
    row["rmse_position_m"] = position;
    row["rmse_heading_rad"] = 0.01 * position;
    row["nees_mean"] = 3.0 * position;
  }
  return row;
}

/// A cell as campaign_to_json writes it, with `done` runs of position RMSE 1, 2, 3, ...
Json make_cell(const Json& point, const std::string& variant, int done, std::size_t updates = 40) {
  Json cell = {{"point", point}, {"variant", variant}};
  cell["counts"] = {{"done", done}, {"diverged", 0}, {"failed", 0}, {"not_run", 0}};
  if (done > 0) {
    std::vector<double> times, nees, errors, sigmas;
    for (std::size_t k = 0; k < updates; ++k) {
      times.push_back(0.1 * static_cast<double>(k));
      nees.push_back(k == 0 ? kNone : 3.0 + std::sin(static_cast<double>(k)));
      errors.push_back(std::cos(static_cast<double>(k)));
      sigmas.push_back(0.5);
    }
    cell["truth"] = {{"nees_coverage_95", distribution(0.94)}};
    cell["health"] = {{"landmarks", distribution(29)}};
    cell["calibration"]["scale_left"] = {{"mean", distribution(1.05)},
                                         {"sigma", distribution(0.22)},
                                         {"observable", distribution(0)}};
    cell["pooled"] = {
        {"rmse_x_m", 3.0}, {"rmse_y_m", 4.0}, {"rmse_position_m", 5.0}, {"rmse_heading_rad", 0.1}};
    cell["nees"] = {{"steps", updates}, {"times_s", times},
                    {"mean", nees},     {"lower", 2.3},
                    {"upper", 3.7},     {"fraction_in_band", 0.9},
                    {"time_mean", 3.1}, {"batches", {{{"runs", done}, {"fraction_in_band", 0.9}}}}};
    cell["example"] = {{"times_s", times},
                       {"errors", {errors, errors, errors}},
                       {"sigmas", {sigmas, sigmas, sigmas}}};
  }
  cell["runs"] = Json::array();
  for (int i = 1; i <= done; ++i) cell["runs"].push_back(run_row(i, "done", i));
  return cell;
}

Json make_campaign(std::vector<Json> cells) {
  return {{"program", "slam-campaign"},
          {"version", "1.2.3"},
          {"git", "abc"},
          {"config_sha256", "0123456789abcdef"},
          {"seed", 7},
          {"runs", 5},
          {"batches", 2},
          {"cells", std::move(cells)},
          {"timing", {{"wall_s", 1.5}, {"workers", 2}}}};
}

Json compared(Json cell) {
  cell["comparison"] = {
      {"reference", "standard"},
      {"rmse_position", {{"ratio", 0.25}, {"lower", 0.2}, {"upper", 0.3}, {"pairs", 5}}}};
  return cell;
}

bool has(const std::string& page, const std::string& text) {
  return page.find(text) != std::string::npos;
}

/// The text between two marks, which must both be there.
std::string between(const std::string& page, const std::string& open, const std::string& close) {
  const std::size_t begin = page.find(open);
  const std::size_t end = page.find(close, begin);
  if (begin == std::string::npos || end == std::string::npos) return "";
  return page.substr(begin + open.size(), end - begin - open.size());
}

/// A stand-in for the plotting library, in a folder of its own.
class CampaignReportTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("campaign_report_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "d3.min.js") << "var d3 = {};";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string page_of(const Json& campaign) const {
    return make_campaign_report(campaign, "the campaign", folder_);
  }

  std::filesystem::path folder_;
};

TEST_F(CampaignReportTest, EmbedsItsNumbersAsValidJsonAndLoadsNothing) {
  const Json campaign = make_campaign({make_cell(Json::object(), "standard", 5)});
  const std::string page = page_of(campaign);
  const std::string text =
      between(page, "<script type=\"application/json\" id=\"data\">", "</script>");
  ASSERT_TRUE(Json::accept(text));
  EXPECT_EQ(Json::parse(text), make_campaign_report_data(campaign));
  EXPECT_FALSE(has(page, "{{"));
  EXPECT_TRUE(has(page, "default-src 'none'"));
  for (const char* loader : {"src=", "href=", "@import", "url(http", "<link", "<iframe", "<img"})
    EXPECT_FALSE(has(page, loader)) << loader;
}

TEST_F(CampaignReportTest, HostileNamesAndReasonsCannotBecomeMarkup) {
  const std::string hostile = "</script><b>&\xff";
  Json cell = make_cell({{"filter.<i>key", "<u>1</u>"}}, hostile, 2);
  cell["calibration"]["<em>"] = cell["calibration"]["scale_left"];
  cell["runs"].push_back(run_row(3, "failed: <img src=x onerror=y>", 0));
  cell["counts"]["failed"] = 1;
  Json other = compared(make_cell({{"filter.<i>key", "<u>2</u>"}}, "plain", 2));
  other["comparison"]["reference"] = hostile;
  for (const auto& folder : {folder_, folder_ / "nowhere"}) {
    const std::string page =
        make_campaign_report(make_campaign({cell, other}), "<s>title</s>", folder);
    for (const char* markup : {"<b>", "<i>", "<u>", "<em>", "<img", "<s>"})
      EXPECT_FALSE(has(page, markup)) << markup;
    EXPECT_TRUE(has(page, "&lt;/script&gt;&lt;b&gt;&amp;"));
    EXPECT_TRUE(has(page, "failed: &lt;img src=x"));
  }
}

TEST_F(CampaignReportTest, WithoutTheLibraryThereAreStillDrawingsAndTheTable) {
  const std::string page = make_campaign_report(
      make_campaign({make_cell(Json::object(), "standard", 5)}), "still", folder_ / "nowhere");
  EXPECT_TRUE(has(page, "libjs-d3"));
  EXPECT_TRUE(has(page, "<polyline class=\"estimate-line\""));
  EXPECT_TRUE(has(page, "<table>"));
  EXPECT_FALSE(has(page, "<script"));
}

TEST_F(CampaignReportTest, ACampaignWithoutResultsSaysSo) {
  Json cell = make_cell(Json::object(), "standard", 0);
  cell["counts"] = {{"done", 0}, {"diverged", 1}, {"failed", 1}, {"not_run", 1}};
  cell["runs"] = {run_row(1, "diverged", 0), run_row(2, "failed: no log", 0),
                  run_row(3, "not run", 0)};
  const Json campaign = make_campaign({cell});
  const Json shown = make_campaign_report_data(campaign)["points"][0]["cells"][0];
  EXPECT_EQ(shown["runs"], 3);
  for (const char* part : {"nees", "errors", "ratio"}) EXPECT_TRUE(shown[part].is_null()) << part;
  for (const Json& box : shown["boxes"]) EXPECT_TRUE(box.is_null());
  const std::string page = page_of(campaign);
  EXPECT_TRUE(has(page, "0/3<br><span class=\"lost\">1 diverged</span>"));
  EXPECT_TRUE(has(page, "standard, seed 2: failed: no log"));
  EXPECT_FALSE(has(page, "seed 3: not run"));
  EXPECT_FALSE(has(page, "nan"));
}

TEST_F(CampaignReportTest, ACampaignWithoutCellsStillHasAPage) {
  const std::string page = page_of(make_campaign({}));
  EXPECT_TRUE(has(page, "id=\"plots\""));
  EXPECT_TRUE(has(page, "0123456789ab"));
  EXPECT_FALSE(has(page, "0123456789abc"));
}

TEST_F(CampaignReportTest, OnlyTheListedLostRunsAreNamedAndTheOthersCounted) {
  Json cell = make_cell(Json::object(), "standard", 0);
  for (int seed = 1; seed <= 30; ++seed) cell["runs"].push_back(run_row(seed, "diverged", 0));
  const std::string html = lost_runs_html(make_campaign({cell}));
  EXPECT_TRUE(has(html, "seed 20: diverged"));
  EXPECT_FALSE(has(html, "seed 21: diverged"));
  EXPECT_TRUE(has(html, "10 more"));
}

TEST(CampaignReportTable, ShowsPooledErrorsRatiosAndCalibration) {
  const Json campaign = make_campaign(
      {make_cell(Json::object(), "standard", 5), compared(make_cell(Json::object(), "ours", 5))});
  const std::string html = campaign_table_html(campaign);
  EXPECT_TRUE(has(html, "5.000 <small>3.00, 4.00</small>"));
  EXPECT_TRUE(has(html, "0.250 <small>[0.200, 0.300]</small>"));
  EXPECT_TRUE(has(html, "reference</span>"));
  EXPECT_TRUE(has(html, "<td>5.730</td>"));  // 0.1 rad in degrees
  EXPECT_TRUE(has(html, "scale_left 1.0500 \u00b1 0.5000"));
  EXPECT_TRUE(has(html, "not observable"));
  EXPECT_TRUE(has(campaign_cards_html(campaign), "7 \u2026 16"));
}

TEST(CampaignReportData, BoxesAreQuantilesOfTheDoneRuns) {
  Json cell = make_cell(Json::object(), "standard", 5);
  cell["runs"].push_back(run_row(6, "diverged", 1e9));
  const Json data = make_campaign_report_data(make_campaign({cell}));
  // Of 1, 2, 3, 4, 5, linear between order statistics.
  EXPECT_EQ(data["points"][0]["cells"][0]["boxes"]["position"],
            Json({1.0, 1.2, 2.0, 3.0, 4.0, 4.8, 5.0}));
}

TEST(CampaignReportData, ASingleRunIsABoxWithoutWidth) {
  const Json data = make_campaign_report_data(make_campaign({make_cell(Json::object(), "a", 1)}));
  const Json& cell = data["points"][0]["cells"][0];
  EXPECT_EQ(cell["boxes"]["position"], Json(std::vector<double>(7, 1.0)));
  EXPECT_EQ(cell["nees"]["runs"], 1);
  EXPECT_TRUE(cell["nees"]["mean"][0].is_null());
  EXPECT_EQ(cell["errors"][0]["bound"][3], 1.5);
  EXPECT_TRUE(data["grid"].is_null());
}

TEST(CampaignReportData, TiedSettingsAreOneAxisAndCrossedOnesAreNot) {
  const auto at = [](const char* left, const char* right) {
    return make_cell({{"scenario.scale_left", left}, {"scenario.scale_right", right}}, "a", 1);
  };
  const Json tied =
      make_campaign_report_data(make_campaign({at("1.0", "1.0"), at("1.05", "1.05")}));
  EXPECT_EQ(tied["grid"]["values"], Json({1.0, 1.05}));
  EXPECT_EQ(tied["grid"]["name"], "scale_left, scale_right");
  EXPECT_EQ(tied["points"][1]["label"], "scale_left = scale_right = 1.05");
  const Json crossed = make_campaign_report_data(make_campaign({at("1.0", "1.0"), at("1.0", "2")}));
  EXPECT_TRUE(crossed["grid"]["values"].is_null());
  EXPECT_EQ(crossed["points"][1]["label"], "scale_left = 1.0, scale_right = 2");
}

TEST(CampaignReportData, WordsAreNoAxis) {
  const auto at = [](const char* frame) { return make_cell({{"filter.frame", frame}}, "a", 1); };
  const Json data = make_campaign_report_data(make_campaign({at("standard"), at("invariant")}));
  EXPECT_TRUE(data["grid"]["values"].is_null());
}

TEST(CampaignReportData, VariantsKeepTheirPlaceWhereAPointLacksOne) {
  const Json data = make_campaign_report_data(
      make_campaign({make_cell({{"k", "1"}}, "a", 1), make_cell({{"k", "1"}}, "b", 1),
                     make_cell({{"k", "2"}}, "b", 1)}));
  EXPECT_EQ(data["variants"], Json({"a", "b"}));
  EXPECT_TRUE(data["points"][1]["cells"][0].is_null());
  EXPECT_EQ(data["points"][1]["cells"][1]["done"], 1);
}

TEST(CampaignReportData, EqualLastPartsOfKeysAreWrittenInFull) {
  EXPECT_EQ(point_label({{"a.sigma", "1"}, {"b.sigma", "2"}}), "a.sigma = 1, b.sigma = 2");
  EXPECT_EQ(point_label(Json::object()), "");
}

TEST(CampaignReportData, DecimationKeepsExtremesAndBoundsTheNumber) {
  std::vector<double> values(10'000);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = std::sin(0.01 * static_cast<double>(i));
  values[0] = kNone;
  values[4321] = 50.0;
  values[4322] = -60.0;
  const auto indices = extreme_indices(values, 600);
  EXPECT_LE(indices.size(), 600u);
  EXPECT_GE(indices.size(), 300u);
  EXPECT_TRUE(std::is_sorted(indices.begin(), indices.end()));
  for (const std::size_t peak : {4321u, 4322u})
    EXPECT_NE(std::find(indices.begin(), indices.end(), peak), indices.end());
  EXPECT_EQ(extreme_indices(std::vector<double>(600, 1.0), 600).size(), 600u);
  EXPECT_TRUE(extreme_indices({}, 600).empty());
}

TEST(CampaignReportData, ThePageGrowsWithTheCellsUntilCurvesGiveWay) {
  const auto data_with = [](int cells, std::size_t updates) {
    std::vector<Json> list;
    for (int i = 0; i < cells; ++i)
      list.push_back(make_cell({{"k", std::to_string(i)}}, "a", 1, updates));
    return make_campaign_report_data(make_campaign(std::move(list)));
  };
  const Json fifty = data_with(50, 1200), hundred = data_with(100, 1200), many = data_with(601, 4);
  EXPECT_EQ(fifty["points"][0]["cells"][0]["nees"]["t"].size(), 600u);
  EXPECT_EQ(hundred["points"][0]["cells"][0]["nees"]["t"].size(), 300u);
  EXPECT_LT(hundred.dump().size(), 5'000'000u);
  EXPECT_TRUE(hundred["curves"]);
  EXPECT_FALSE(many["curves"]);
  EXPECT_TRUE(many["points"][0]["cells"][0]["nees"].is_null());
}

}  // namespace
}  // namespace libslam
