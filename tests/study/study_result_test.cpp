#include "engine/study/study_result.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/study/study_output.hpp"

namespace sluice {
namespace {

StudyRow done(double error, double core_seconds) {
  StudyRow row;
  row.state = RunState::completed;
  row.error = error;
  row.core_seconds = core_seconds;
  return row;
}

StudyRun run_of(const std::string& setup, const std::string& suffix = "") {
  StudyRun run;
  run.setup = setup;
  run.name = setup + suffix;
  run.of_case = setup;
  return run;
}

Study study_with(std::vector<double> targets) {
  Study study;
  study.name = "made-up";
  study.targets = std::move(targets);
  return study;
}

/// a: cheap and bad; b: in between; c: worse and dearer than b; d: dear and good.
StudyResult four() {
  return evaluate(study_with({0.5, 0.25, 0.01}),
                  {run_of("a"), run_of("b"), run_of("c"), run_of("d")},
                  {done(0.4, 1.0), done(0.2, 5.0), done(0.3, 6.0), done(0.1, 50.0)});
}

TEST(StudyResult, PutsOnTheFrontWhatNothingBeats) {
  const StudyResult result = four();
  EXPECT_TRUE(result.setups[0].on_front);
  EXPECT_TRUE(result.setups[1].on_front);
  EXPECT_FALSE(result.setups[2].on_front);
  EXPECT_TRUE(result.setups[3].on_front);
}

TEST(StudyResult, FindsTheCheapestBelowEachTarget) {
  const StudyResult result = four();
  EXPECT_EQ(result.cheapest[0].setup, 0u);
  EXPECT_EQ(result.cheapest[1].setup, 1u);
  EXPECT_FALSE(result.cheapest[2].setup);
  EXPECT_NE(study_text(result).find("none of these"), std::string::npos);
}

TEST(StudyResult, WithoutAReferenceShowsCostsAndTheDifferenceFromTheFinest) {
  std::vector<StudyRun> runs;
  std::vector<StudyRow> rows;
  for (const double spacing : {0.04, 0.02, 0.01}) {
    StudyRun run = run_of("dx " + std::to_string(spacing));
    run.of_case = "base";
    run.values = {{"/resolution/spacing", std::to_string(spacing)}};
    run.scene.method.spacing = spacing;
    runs.push_back(run);
    StudyRow row = done(0.0, 1.0 / spacing);
    row.error.reset();
    row.reason = "no error: its scene has no reference";
    row.quantities = {{"P1 mean", 100.0 * (1.0 - spacing)}, {"H mean", 2.0}};
    rows.push_back(row);
  }
  const StudyResult result = evaluate(study_with({}), runs, rows);
  EXPECT_DOUBLE_EQ(*result.setups[0].core_seconds, 25.0);
  EXPECT_NEAR(*result.setups[0].difference, 0.5 * (99.0 - 96.0) / 99.0, 1e-12);
  EXPECT_EQ(*result.setups[2].difference, 0.0);
  ASSERT_EQ(result.convergence.size(), 2u);
  EXPECT_NEAR(*result.convergence[0].richardson->order, 1.0, 1e-9);
  const std::string text = study_text(result);
  EXPECT_EQ(text.find("Runs without a result"), std::string::npos) << text;
  EXPECT_NE(text.find("from the finest"), std::string::npos);
}

TEST(StudyResult, CountsNoFailedRunAndShowsItWithItsReason) {
  StudyRow failed;
  failed.state = RunState::failed;
  failed.reason = "speed above c";
  const StudyResult result =
      evaluate(study_with({1.0}), {run_of("a"), run_of("b")}, {failed, done(0.3, 2.0)});
  EXPECT_FALSE(result.setups[0].on_front);
  EXPECT_FALSE(result.setups[0].error);
  EXPECT_EQ(result.cheapest[0].setup, 1u);
  EXPECT_NE(study_text(result).find("failed"), std::string::npos);
  EXPECT_NE(study_text(result).find("speed above c"), std::string::npos);
  EXPECT_NE(study_csv(result).find("a,a,a,failed,,"), std::string::npos);
  EXPECT_TRUE(study_json(result)["runs"][0]["error"].is_null());
  EXPECT_NE(chart_svg(study_chart(result), SvgPlace::file).find("failed, so not drawn: a"),
            std::string::npos);
}

TEST(StudyResult, AveragesRepeatsAndTellsTheirSpread) {
  const StudyResult result =
      evaluate(study_with({}), {run_of("a", "-r1"), run_of("a", "-r2"), run_of("a", "-r3")},
               {done(0.1, 1.0), done(0.3, 2.0), done(0.2, 6.0)});
  ASSERT_EQ(result.setups.size(), 1u);
  EXPECT_NEAR(*result.setups[0].error, 0.2, 1e-12);
  EXPECT_DOUBLE_EQ(*result.setups[0].lowest_error, 0.1);
  EXPECT_DOUBLE_EQ(*result.setups[0].highest_error, 0.3);
  EXPECT_DOUBLE_EQ(*result.setups[0].core_seconds, 3.0);
}

TEST(StudyResult, GivesNoMeanAsLongAsARepeatIsMissing) {
  const StudyResult result = evaluate(study_with({}), {run_of("a", "-r1"), run_of("a", "-r2")},
                                      {done(0.1, 1.0), StudyRow{}});
  EXPECT_FALSE(result.setups[0].error);
  EXPECT_EQ(result.setups[0].completed, 1u);
}

/// Runs at four spacings whose error falls with the second power and whose plateau goes to 0.6.
StudyResult ladder() {
  std::vector<StudyRun> runs;
  std::vector<StudyRow> rows;
  for (const double spacing : {0.008, 0.004, 0.002, 0.001}) {
    StudyRun run = run_of("case-" + std::to_string(spacing));
    run.of_case = "case";
    run.values = {{"/resolution/spacing", std::to_string(spacing)}};
    run.scene.method.spacing = spacing;
    StudyRow row = done(100.0 * spacing * spacing, 1.0 / spacing);
    row.quantities = {{"P1 plateau", 0.6 + 3.0 * spacing}};
    runs.push_back(std::move(run));
    rows.push_back(std::move(row));
  }
  return evaluate(study_with({}), std::move(runs), std::move(rows));
}

TEST(StudyResult, MeasuresTheOrderOverTheSpacings) {
  const StudyResult result = ladder();
  ASSERT_EQ(result.convergence.size(), 2u);
  EXPECT_EQ(result.convergence[0].quantity, "error");
  EXPECT_NEAR(*result.convergence[0].order_of_error, 2.0, 1e-9);
  EXPECT_EQ(result.convergence[1].quantity, "P1 plateau");
  EXPECT_NEAR(*result.convergence[1].richardson->order, 1.0, 1e-9);
  EXPECT_NEAR(*result.convergence[1].richardson->extrapolated, 0.6, 1e-9);
}

TEST(StudyResult, DrawsEverySetUpAndJoinsTheFrontInOrderOfCost) {
  const Chart chart = study_chart(four());
  ASSERT_EQ(chart.lines.size(), 1u);
  EXPECT_EQ(chart.lines[0].x, (std::vector<double>{1.0, 5.0, 50.0}));
  std::size_t points = 0;
  for (const ChartMarks& marks : chart.marks) points += marks.x.size();
  EXPECT_EQ(points, 4u);
  EXPECT_EQ(chart.x.scale, AxisScale::logarithmic);
  EXPECT_LT(chart.x.low, 1.0);
  EXPECT_GT(chart.x.high, 50.0);
}

TEST(StudyResult, WithoutAnyCompletedRunIsStillAResult) {
  const StudyResult result = evaluate(study_with({0.1}), {run_of("a")}, {StudyRow{}});
  EXPECT_FALSE(study_text(result).empty());
  EXPECT_FALSE(study_markdown(result).empty());
  EXPECT_FALSE(chart_svg(study_chart(result), SvgPlace::file).empty());
}

}  // namespace
}  // namespace sluice
