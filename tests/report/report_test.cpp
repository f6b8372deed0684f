#include "engine/report/report.hpp"
#include "engine/report/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/store/disk/errors.hpp"

namespace sluice {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

Series probe() {
  Series series;
  series.name = "probe";
  series.kind = "surface_height";
  series.columns = {{"value", "m"}};
  series.time = {0.0, 1.0, 2.0, 3.0};
  series.duration = {0.0, 1.0, 1.0, 1.0};
  series.values = {kMissing, 0.5, 2.0, 1.0};
  series.weight = {0.0, 1.0, 1.0, 1.0};
  return series;
}

Scene scene_of_no_experiment() {
  Scene scene;
  scene.name = "puddle";
  return scene;
}

TEST(Report, SummarisesASensorByItsFirstWetItsHighestAndItsLastSample) {
  const Report report = make_report(scene_of_no_experiment(), {probe()}, nullptr);
  ASSERT_EQ(report.sensors.size(), 1u);
  const SensorSummary& sensor = report.sensors[0];
  EXPECT_EQ(sensor.samples, 4u);
  EXPECT_DOUBLE_EQ(*sensor.first_wet, 1.0);
  EXPECT_DOUBLE_EQ(*sensor.highest, 2.0);
  EXPECT_DOUBLE_EQ(*sensor.highest_at, 2.0);
  EXPECT_DOUBLE_EQ(*sensor.last, 1.0);
}

TEST(Report, HasTheLowestValueBesideTheHighest) {
  Series level = probe();
  level.values = {3.0, -2.0, kMissing, 1.0};
  level.weight = {1.0, 1.0, 0.0, 1.0};
  const SensorSummary sensor =
      make_report(scene_of_no_experiment(), {level}, nullptr).sensors.at(0);
  EXPECT_DOUBLE_EQ(*sensor.lowest, -2.0);
  EXPECT_DOUBLE_EQ(*sensor.lowest_at, 1.0);
  // Samples 1 and 3 stand for a second each, sample 0 for none.
  EXPECT_DOUBLE_EQ(*sensor.mean, -0.5);
}

TEST(Report, IsWetFromWhereFluidIsSeenWhateverTheAirsPressure) {
  Series pressure = probe();
  pressure.kind = "pressure";
  pressure.values = {0.0, 0.0, 700.0, 700.0};
  pressure.weight = {0.0, 0.0, 0.4, 1.0};
  EXPECT_DOUBLE_EQ(*make_report(scene_of_no_experiment(), {pressure}, nullptr).sensors[0].first_wet,
                   2.0);
}

TEST(Report, TakesEnergiesFromTheOutcomeWhereNoSensorMeasuresThem) {
  nlohmann::ordered_json outcome{{"energy", 9.0}};
  outcome["extremes"] = {{"initial_energy", 10.0}, {"highest_energy", 11.0}, {"energy_scale", 5.0}};
  const Conservation kept = conservation_of({}, run_facts(outcome));
  EXPECT_EQ(kept.first_energy, 10.0);
  EXPECT_EQ(kept.last_energy, 9.0);
  EXPECT_EQ(kept.highest_energy, 11.0);
}

TEST(Report, SaysWhatASurgeFrontIs) {
  Series front = probe();
  front.kind = "surge_front";
  EXPECT_NE(report_text(make_report(scene_of_no_experiment(), {front}, nullptr))
                .find("largest x of any fluid particle"),
            std::string::npos);
}

TEST(Report, HasItsFiguresBeforeItsTables) {
  const Report report = make_report(scene_of_no_experiment(), {probe()}, nullptr);
  const std::string page = report_html(report, {probe()}, {});
  EXPECT_LT(page.find("<svg"), page.find("<table"));
}

TEST(Report, HasAPageWithABoundedNumberOfPlots) {
  std::vector<Series> many;
  for (std::size_t i = 0; i < 100; ++i) {
    many.push_back(probe());
    many.back().name = "probe " + std::to_string(i);
  }
  const Report report = make_report(scene_of_no_experiment(), many, nullptr);
  EXPECT_EQ(report_charts(report, many).size(), kMostCharts);
  const std::string page = report_html(report, many, {});
  EXPECT_NE(page.find("plots at most"), std::string::npos);
  EXPECT_NE(page.find("probe 99"), std::string::npos) << "the table lists every sensor";
  EXPECT_EQ(report_html(report, {probe()}, {}).find("plots at most"), std::string::npos);
}

TEST(Report, OfASensorThatStayedDryHasNoValuesRatherThanZeros) {
  Series dry = probe();
  dry.values.assign(4, kMissing);
  const Report report = make_report(scene_of_no_experiment(), {dry}, nullptr);
  EXPECT_FALSE(report.sensors[0].first_wet);
  EXPECT_TRUE(report_json(report).at("sensors").at(0).at("highest").is_null());
}

TEST(Report, OfAConstantPressureIsThatPressure) {
  Series pressure = probe();
  pressure.kind = "pressure";
  pressure.values.assign(4, 700.0);
  const Report report = make_report(scene_of_no_experiment(), {pressure}, nullptr, 0.5);
  EXPECT_NEAR(*report.sensors[0].highest, 700.0, 1e-9);
}

TEST(Report, FiltersEachSensorBesideOthersAsAlone) {
  std::vector<Series> all(4, probe());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].name = "probe " + std::to_string(i);
    all[i].kind = i == 1 ? "surface_height" : "pressure";
    for (double& value : all[i].values) value *= 1.0 + static_cast<double>(i);
  }
  for (double& time : all[2].time) time *= 1.5;  // of another table than its neighbours
  const Report together = make_report(scene_of_no_experiment(), all, nullptr, 0.7);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Report alone = make_report(scene_of_no_experiment(), {all[i]}, nullptr, 0.7);
    EXPECT_EQ(together.sensors[i].name, all[i].name);
    EXPECT_EQ(together.sensors[i].highest, alone.sensors[0].highest) << i;
    EXPECT_EQ(together.sensors[i].highest_at, alone.sensors[0].highest_at) << i;
    EXPECT_EQ(together.sensors[i].last, alone.sensors[0].last) << i;
  }
}

TEST(Report, SaysThatNoExperimentMatchesAndThatTheRunHasNotEnded) {
  const Report report = make_report(scene_of_no_experiment(), {probe()}, nullptr);
  EXPECT_FALSE(report.comparison);
  const std::string text = report_text(report);
  EXPECT_NE(text.find("no experiment"), std::string::npos);
  EXPECT_NE(text.find("has not ended"), std::string::npos);
  EXPECT_TRUE(report_json(report).at("comparison").is_null());
  EXPECT_TRUE(report_json(report).at("outcome").is_null());
}

TEST(Report, SurvivesAnOutcomeOfAnotherLayout) {
  for (const char* text : {"3", "[]", "{}", R"({"this_attempt": 3, "retired": [], "state": 1})",
                           R"({"this_attempt": {"passes": [1, {"name": 2}, {"seconds": "x"}]}})"}) {
    const auto outcome = nlohmann::ordered_json::parse(text);
    EXPECT_FALSE(report_text(make_report(scene_of_no_experiment(), {}, outcome)).empty()) << text;
  }
}

nlohmann::ordered_json outcome_of(double steps_of_attempt, double core_seconds) {
  nlohmann::ordered_json outcome{{"state", "completed"}, {"step", 400}, {"particles", 90}};
  outcome["removed"] = {{"overtopped", 9}, {"leaked", 1}};
  outcome["threads"] = 2;
  outcome["this_attempt"] = {
      {"seconds", 7.0}, {"steps", steps_of_attempt}, {"core_seconds", core_seconds}};
  return outcome;
}

TEST(Report, CountsTheCoreSecondsOfAWholeRun) {
  const RunFacts facts = run_facts(outcome_of(400, 12.0));
  EXPECT_DOUBLE_EQ(*facts.core_seconds, 12.0);
  EXPECT_FALSE(facts.core_seconds_scaled);
}

TEST(Report, ScalesTheLastAttemptsCostToAllStepsAndSaysSo) {
  const RunFacts facts = run_facts(outcome_of(100, 3.0));
  EXPECT_DOUBLE_EQ(*facts.core_seconds, 12.0);
  EXPECT_TRUE(facts.core_seconds_scaled);
}

TEST(Report, HasNoCostWhereTheLastAttemptDidNoStep) {
  EXPECT_FALSE(run_facts(outcome_of(0, 0.1)).core_seconds);
}

TEST(Report, TakesWallTimeTimesThreadsOfAnOutcomeWithoutProcessorTime) {
  auto outcome = outcome_of(400, 0.0);
  outcome["this_attempt"].erase("core_seconds");
  EXPECT_DOUBLE_EQ(*run_facts(outcome).core_seconds, 14.0);
}

TEST(Report, TellsWhatShareOfTheMassLeft) {
  const Report report = make_report(scene_of_no_experiment(), {}, outcome_of(400, 12.0));
  EXPECT_DOUBLE_EQ(*report.conservation.lost_mass, 0.1);
}

TEST(Report, HoldsWhatTheGuardsSawAgainstTheirLimits) {
  auto outcome = outcome_of(400, 12.0);
  outcome["extremes"] = {{"max_speed", 2.0},
                         {"min_density_ratio", 0.93},
                         {"max_density_ratio", 1.07},
                         {"min_time_step", 2.5e-5},
                         {"max_neighbours", 0}};
  const Report report = make_report(scene_of_no_experiment(), {}, outcome);
  const std::string text = report_text(report);
  for (const char* part : {"0.9300", "1.070", "2.5e-05", "never above 200"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in:\n" << text;
  }
  EXPECT_EQ(report_json(report)["extremes"]["min_density_ratio"], 0.93);
}

TEST(Report, SumsTheKindsOfEnergy) {
  Series energy;
  energy.name = "energy";
  energy.kind = "energy";
  energy.columns = {{"kinetic", "J/m"}, {"potential", "J/m"}};
  energy.time = {0.0, 1.0, 2.0};
  energy.duration = {0.0, 1.0, 1.0};
  energy.values = {0.0, 10.0, 7.0, 5.0, 3.0, 4.0};
  energy.weight = {1.0, 1.0, 1.0};
  const Conservation kept = conservation_of({energy}, {});
  EXPECT_DOUBLE_EQ(*kept.first_energy, 10.0);
  EXPECT_DOUBLE_EQ(*kept.highest_energy, 12.0);
  EXPECT_DOUBLE_EQ(*kept.last_energy, 7.0);
}

TEST(Report, AsAPageRunsNoScriptAndLoadsNothing) {
  Scene scene = scene_of_no_experiment();
  scene.description = "<script>alert(1)</script> & <img src=x>";
  const Report report = make_report(scene, {probe()}, outcome_of(400, 12.0));
  const std::string page = report_html(report, {probe()}, {});
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;"), std::string::npos);
  EXPECT_EQ(page.find("src="), page.find("src=x&gt;")) << "nothing is fetched";
  EXPECT_EQ(page.find("url(http"), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos);
}

TEST(Report, AsMarkdownLeavesNoTableOpenToATextOfTheUser) {
  Scene scene = scene_of_no_experiment();
  scene.description = "a | b <b> [link](x)";
  const std::string text = report_markdown(make_report(scene, {probe()}, nullptr));
  EXPECT_NE(text.find("a \\| b \\<b> \\[link](x)"), std::string::npos);
}

TEST(Report, AsTextAndMarkdownHasNothingThatATerminalObeys) {
  Scene scene = scene_of_no_experiment();
  // Bell, escape, C1 controls, a direction turned, a line broken, a tag; and letters of all
  // lengths.
  const std::string nasty =
      "a\x07\x1b\xC2\x9B\xC2\x85\xE2\x80\xAE\xE2\x80\xA8\xF3\xA0\x81\x81z "
      "\xC3\xBC\xE2\x88\x9A\xF0\x9F\x8C\x8A";
  scene.name = nasty;
  scene.description = nasty;
  Series sensor = probe();
  sensor.name = nasty;
  const Report report = make_report(scene, {sensor}, nullptr);
  const std::string clean = "a???????z \xC3\xBC\xE2\x88\x9A\xF0\x9F\x8C\x8A";
  for (const std::string& text : {report_text(report), report_markdown(report)}) {
    EXPECT_NE(text.find(clean + "\n"), std::string::npos) << text;
    EXPECT_EQ(text.find_first_of("\x07\x1b"), std::string::npos);
    for (const char* const hidden :
         {"\xC2\x9B", "\xC2\x85", "\xE2\x80\xAE", "\xE2\x80\xA8", "\xF3\xA0\x81\x81"}) {
      EXPECT_EQ(text.find(hidden), std::string::npos);
    }
  }
}

SceneReference straight_line() {
  SceneReference reference;
  reference.kind = ReferenceKind::series;
  reference.title = "half of it";
  reference.curves = {{"probe", {1.0, 2.0, 3.0}, {0.5, 0.5, 0.5}, {}, {}}};
  return reference;
}

/// A level of 1 m all the time against 0.5 m: the error is as large as the reference.
TEST(Report, ComparesASensorWithTheCurveThatItsSceneGives) {
  Scene scene = scene_of_no_experiment();
  scene.reference = straight_line();
  Series level = probe();
  level.time = {0.0, 1.0, 2.0, 4.0};
  level.values = {1.0, 1.0, 1.0, 1.0};
  const Report report = make_report(scene, {level}, nullptr);
  ASSERT_TRUE(report.series_comparison);
  const CurveComparison& curve = report.series_comparison->curves.at(0);
  EXPECT_NEAR(*curve.relative_l2, 1.0, 1e-12);
  EXPECT_NEAR(*curve.rms_difference, 0.5, 1e-12);
  EXPECT_NEAR(*report.error(), 1.0, 1e-12);
}

TEST(Report, HasNoErrorWhereTheRunEndsBeforeItsReference) {
  Scene scene = scene_of_no_experiment();
  scene.reference = straight_line();
  EXPECT_FALSE(make_report(scene, {probe()}, nullptr).error());
}

TEST(Report, HasNoErrorForASensorWithoutSamples) {
  Scene scene = scene_of_no_experiment();
  scene.reference = straight_line();
  const Report report = make_report(scene, {}, nullptr);
  EXPECT_FALSE(report.error());
  EXPECT_FALSE(report_html(report, {}, {}).empty());
}

TEST(Report, OfAFolderWithoutAJobSaysWhatToName) {
  const std::filesystem::path empty = std::filesystem::temp_directory_path() / "sluice-no-such-job";
  try {
    (void)report_of_folder(empty);
    FAIL() << "was accepted";
  } catch (const StorageError& error) {
    EXPECT_EQ(error.fault(), StorageFault::not_ours);
    EXPECT_NE(std::string(error.what()).find(empty.string()), std::string::npos);
  }
}

}  // namespace
}  // namespace sluice
