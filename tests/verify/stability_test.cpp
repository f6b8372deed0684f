// The suite's own code on runs made by hand: verdicts, gates, tables.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/format/canonical.hpp"
#include "engine/verify/stability_map.hpp"
#include "engine/verify/stability_report.hpp"
#include "engine/verify/stability_scenes.hpp"

namespace sluice {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

CaseRun refused_run() {
  CaseRun run;
  run.problems = {{"/tank/width", "is -1; must be above 0"}, {"/fluid", "is missing"}};
  return run;
}

CaseRun failed_run() {
  CaseRun run;
  run.outcome.exit_code = ExitCode::numerical_failure;
  run.outcome.reason = "density too high";
  run.outcome.diagnosis = Diagnosis{.reason = "density too high",
                                    .step = 17,
                                    .time = 0.25,
                                    .value = 1.4,
                                    .limit = 1.3,
                                    .suggestion = "raise the sound speed"};
  run.checkpoint = "001-case/checkpoint-000000000010.h5";
  return run;
}

CaseRun warned_run() {
  CaseRun run;
  run.warnings = {"speed above 0.3 c", "another"};
  return run;
}

TEST(StabilityVerdict, FollowsFromHowTheRunEnded) {
  EXPECT_EQ(result_of(refused_run(), Verdict::rejected).verdict, Verdict::rejected);
  EXPECT_EQ(result_of(failed_run(), Verdict::stable).verdict, Verdict::unstable);
  EXPECT_EQ(result_of(warned_run(), Verdict::stable).verdict, Verdict::stable_with_warnings);
  EXPECT_EQ(result_of(CaseRun{}, Verdict::stable).verdict, Verdict::stable);
}

TEST(StabilityVerdict, NamesTheFirstReason) {
  EXPECT_EQ(result_of(refused_run(), Verdict::rejected).reason,
            "/tank/width is -1; must be above 0");
  EXPECT_EQ(result_of(failed_run(), Verdict::unstable).reason, "density too high");
  EXPECT_EQ(result_of(warned_run(), Verdict::stable).reason, "speed above 0.3 c");
  EXPECT_EQ(result_of(CaseRun{}, Verdict::stable).reason, "");
}

TEST(StabilityVerdict, IsAsExpectedOnlyForTheVerdictsThatACaseMayEndWith) {
  EXPECT_TRUE(result_of(CaseRun{}, Verdict::stable).as_expected);
  EXPECT_FALSE(result_of(CaseRun{}, Verdict::unstable).as_expected);
  EXPECT_FALSE(result_of(warned_run(), Verdict::stable).as_expected);
  EXPECT_TRUE(result_of(warned_run(), Verdict::stable, Verdict::stable_with_warnings).as_expected);
  EXPECT_FALSE(result_of(failed_run(), Verdict::stable, Verdict::stable_with_warnings).as_expected);
}

TEST(StabilityGate, IsMetUpToItsLimitAndNeverByANumberThatIsNone) {
  EXPECT_TRUE((Figure{"x", 0.01, 0.01}.met()));
  EXPECT_FALSE((Figure{"x", std::nextafter(0.01, 1.0), 0.01}.met()));
  EXPECT_FALSE((Figure{"x", kNaN, 0.01}.met()));
  EXPECT_FALSE((Figure{"x", HUGE_VAL, 0.01}.met()));
}

TEST(StabilityGate, ACaseIsMetWhenItsVerdictAndAllItsFiguresAre) {
  CaseResult result;
  EXPECT_TRUE(result.met());
  result.figures = {{"a", 1.0, 2.0}, {"b", 3.0, 2.0}};
  EXPECT_FALSE(result.met());
  result.figures.pop_back();
  EXPECT_TRUE(result.met());
  result.as_expected = false;
  EXPECT_FALSE(result.met());
}

/// A case that is met, one that is missed for a named cause, and one that is missed.
std::vector<JudgedCase> three_cases() {
  const auto named = [](std::string_view name) {
    return StabilityCase{name, "what <it> is", "the gate", nullptr};
  };
  CaseResult good;
  good.figures = {{"error", 0.005, 0.01}};
  CaseResult drifts;
  drifts.verdict = Verdict::drifting;
  drifts.reason = "lifted";
  drifts.figures = {{"error", kNaN, 0.01}};
  return {{named("good"), good, "a cause that does not matter"},
          {named("known"), drifts, "eq. 7 lifts it"},
          {named("bad"), result_of(failed_run(), Verdict::stable)}};
}

TEST(StabilityReport, CountsMissesWithAndWithoutACause) {
  const SuiteTally sum = tally(three_cases());
  EXPECT_EQ(sum.met, 1U);
  EXPECT_EQ(sum.known, 1U);
  EXPECT_EQ(sum.missed, 1U);
  EXPECT_EQ(tally_text(sum), "1 of 3 gates met, 1 missed for the causes named, 1 missed");
  EXPECT_EQ(tally_text({.met = 4}), "4 of 4 gates met");
}

TEST(StabilityReport, ALineHoldsVerdictFiguresAndWhatWasMissed) {
  const auto cases = three_cases();
  const std::string good = suite_line(cases[0]);
  EXPECT_EQ(good.find("met   good"), 0U);
  EXPECT_NE(good.find("error 0.005 (at most 0.01)"), std::string::npos);
  EXPECT_EQ(good.find("cause"), std::string::npos);
  const std::string known = suite_line(cases[1]);
  EXPECT_EQ(known.find("known known"), 0U);
  EXPECT_NE(known.find("gate: the gate"), std::string::npos);
  EXPECT_NE(known.find("cause: eq. 7 lifts it"), std::string::npos);
  EXPECT_EQ(suite_line(cases[2]).find("MISS  bad"), 0U);
}

TEST(StabilityReport, JsonHoldsTheVerdictObjectAndNullForWhatIsNone) {
  const nlohmann::json all = suite_json(three_cases());
  EXPECT_EQ(all["met"], 1);
  EXPECT_EQ(all["known"], 1);
  EXPECT_EQ(all["missed"], 1);
  EXPECT_TRUE(all["cases"][0]["cause"].is_null());
  EXPECT_TRUE(all["cases"][0]["verdict"]["step"].is_null());
  EXPECT_TRUE(all["cases"][0]["verdict"]["reason"].is_null());
  EXPECT_EQ(all["cases"][1]["cause"], "eq. 7 lifts it");
  EXPECT_TRUE(all["cases"][1]["figures"][0]["value"].is_null());
  EXPECT_FALSE(all["cases"][1]["figures"][0]["met"]);
  const nlohmann::json verdict = all["cases"][2]["verdict"];
  EXPECT_EQ(verdict["verdict"], "unstable");
  EXPECT_EQ(verdict["reason"], "density too high");
  EXPECT_EQ(verdict["step"], 17);
  EXPECT_EQ(verdict["time"], 0.25);
  EXPECT_EQ(verdict["value"], 1.4);
  EXPECT_EQ(verdict["limit"], 1.3);
  EXPECT_EQ(verdict["checkpoint"], "001-case/checkpoint-000000000010.h5");
}

TEST(StabilityReport, ThePageHoldsEveryCaseItsCauseAndADotForEachParticle) {
  auto cases = three_cases();
  cases[0].result.picture = {{0.0, 0.0, 0.0}, {0.5, 1.0, 1.0}};
  const std::string page = suite_html(cases);
  EXPECT_NE(page.find("1 of 3 gates met"), std::string::npos);
  EXPECT_NE(page.find("what &lt;it&gt; is"), std::string::npos);
  EXPECT_NE(page.find("eq. 7 lifts it"), std::string::npos);
  EXPECT_EQ(page.find("a cause that does not matter"), std::string::npos);
  std::size_t dots = 0;
  for (auto at = page.find("<circle"); at != std::string::npos; at = page.find("<circle", at + 1)) {
    ++dots;
  }
  EXPECT_EQ(dots, 2U);
}

TEST(StabilityReport, ThePictureIsInUnitsOfTheFluidWithSpeedsOfTheFastest) {
  CaseRun run;
  run.last.emplace();
  Particles& p = run.last->solver.particles;
  p.id = {0, 1};
  p.position[0] = {1.0, 3.0};
  p.position[1] = {5.0, 6.0};
  p.velocity[0] = {0.0, 3.0};
  p.velocity[1] = {2.0, 4.0};
  const std::vector<Dot> dots = result_of(run, Verdict::stable).picture;
  ASSERT_EQ(dots.size(), 2U);
  EXPECT_DOUBLE_EQ(dots[0].x, 0.0);
  EXPECT_DOUBLE_EQ(dots[1].x, 1.0);
  EXPECT_DOUBLE_EQ(dots[1].y, 0.5);
  EXPECT_DOUBLE_EQ(dots[0].speed, 0.4);
  EXPECT_DOUBLE_EQ(dots[1].speed, 1.0);
}

StabilityCell cell(double courant, bool predicted_stable, bool grows) {
  StabilityCell c;
  c.courant = courant;
  c.predicted_stable = predicted_stable;
  c.measured.grows = grows;
  return c;
}

TEST(StabilityMap, TheMeasuredLimitLiesBetweenTheLastStableAndTheFirstGrowingCell) {
  StabilityRow row;
  row.cells = {cell(0.5, true, false), cell(0.7, true, false), cell(0.9, false, true)};
  EXPECT_DOUBLE_EQ(row.measured_limit(), 0.8);
  row.cells[1].measured.grows = true;
  EXPECT_DOUBLE_EQ(row.measured_limit(), 0.6);
  row.cells[0].measured.grows = true;
  EXPECT_DOUBLE_EQ(row.measured_limit(), 0.0);
  for (StabilityCell& each : row.cells) each.measured.grows = false;
  EXPECT_DOUBLE_EQ(row.measured_limit(), 0.9);
}

TEST(StabilityMap, CountsTheCellsThatDifferFromThePrediction) {
  StabilityMap map;
  map.rows.resize(2);
  map.rows[0].cells = {cell(0.5, true, false), cell(0.7, true, true)};
  map.rows[1].cells = {cell(0.5, false, true), cell(0.7, false, false), cell(0.9, false, true)};
  EXPECT_EQ(map.cells(), 5U);
  EXPECT_EQ(map.disagreements(), 2U);
  const nlohmann::json json = map_json(map);
  EXPECT_EQ(json["disagreements"], 2);
  EXPECT_EQ(json["rows"][0]["cells"][1]["measured"], "unstable");
  EXPECT_EQ(json["rows"][1]["cells"][1]["predicted"], "unstable");
}

TEST(StabilityScenes, SchemesAreThoseOfTheExamples) {
  using Sorted = nlohmann::json;  // equal whatever the order of keys
  const auto example = [](const std::string& name) {
    std::ifstream file(std::string(SLUICE_SOURCE_DIR) + "/schemas/examples/" + name);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return Sorted(scheme_of(Sorted::parse(canonical_text(*parse_scene(text).scene))));
  };
  for (const char* name :
       {"dambreak.json", "dambreak-quick.json", "still-water.json", "martin-moyce.json"}) {
    EXPECT_EQ(Sorted(recommended_scheme()), example(name)) << name;
  }
  EXPECT_EQ(Sorted(paper_scheme()), example("dambreak-paper.json"));
}

TEST(StabilityScenes, WithoutATankTheSchemesWallTermsAndItsShiftingAreLeftOut) {
  const nlohmann::json drop = with_scheme(
      without_tank("drop", ball(Vec2::Zero(), 1.0), 0.1, 10.0, 1.0), recommended_scheme());
  EXPECT_FALSE(drop["numerics"].contains("wall_shear"));
  EXPECT_FALSE(drop["numerics"].contains("particle_shifting"));
  EXPECT_EQ(drop["resolution"], (nlohmann::json{{"spacing", 0.1}, {"smoothing_ratio", 1.5}}));
  EXPECT_TRUE(parse_job_scene(drop.dump()).scene.has_value());
  const nlohmann::json tank = with_scheme(still_water("tank", {}), recommended_scheme());
  EXPECT_TRUE(tank["numerics"].contains("wall_shear"));
  EXPECT_TRUE(tank["numerics"].contains("particle_shifting"));
  EXPECT_TRUE(parse_job_scene(tank.dump()).scene.has_value());
}

TEST(StabilityScenes, PressureErrorIsTheRootMeanSquareInUnitsOfTheDepth) {
  StillWater water;
  water.density = 2.0;
  water.gravity = 5.0;
  water.depth = 10.0;  // rho g H = 100
  CaseRun run;
  run.scene.end_time = 10.0;
  for (const auto& [name, depth] : {std::pair{"p0", 0.25}, {"p1", 0.5}, {"p2", 0.75}}) {
    Series probe;
    probe.name = name;
    probe.time = {1.0, 6.0};
    probe.values = {100.0 * (depth + 0.3), 100.0 * (depth - 0.1)};
    run.series.push_back(probe);
  }
  EXPECT_NEAR(pressure_error(run, water, 0.5), 0.1, 1e-12);
  EXPECT_NEAR(pressure_error(run, water, 0.0), std::sqrt((0.09 + 0.01) / 2), 1e-12);
  EXPECT_EQ(pressure_error(run, water, 0.9), HUGE_VAL);
  run.series[1].values[1] = kNaN;
  EXPECT_FALSE((Figure{"error", pressure_error(run, water, 0.5), 1.0}.met()));
}

TEST(StabilityCases, HaveNamesOfTheirOwnAndSayTheirGates) {
  std::set<std::string_view> names;
  for (const StabilityCase& each : all_cases()) {
    EXPECT_TRUE(names.insert(each.name).second) << each.name;
    EXPECT_FALSE(each.about.empty() || each.gate.empty()) << each.name;
    EXPECT_NE(each.judge, nullptr);
  }
}

}  // namespace
}  // namespace sluice
