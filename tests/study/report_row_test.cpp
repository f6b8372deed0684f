#include "engine/study/report_row.hpp"

#include <gtest/gtest.h>

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

TEST(ReportRow, TakesErrorQuantitiesAndCostFromAReport) {
  const StudyRow row = row_of_report(Json::parse(R"({
    "error": 0.25,
    "comparison": {
      "pressures": [{"sensor": "P1", "relative_l2": 0.3,
                     "simulation": {"impulse": 4.5, "plateau": null}}],
      "front": {"delay": -0.1}},
    "cost": {"core_seconds": 12.5, "particle_steps_per_second": 2e7, "steps": 1000,
             "fluid_particles": 500, "machine": "a machine", "simd_target": "AVX2"}})"));
  EXPECT_EQ(row.state, RunState::completed);
  EXPECT_EQ(row.error, 0.25);
  ASSERT_EQ(row.sensor_errors.size(), 1u);
  EXPECT_EQ(row.sensor_errors[0], (std::pair<std::string, double>{"P1", 0.3}));
  const std::vector<std::pair<std::string, double>> quantities{{"P1 impulse", 4.5},
                                                               {"front delay", -0.1}};
  EXPECT_EQ(row.quantities, quantities);
  EXPECT_EQ(row.core_seconds, 12.5);
  EXPECT_EQ(row.particles, 500.0);
  EXPECT_EQ(row.machine, "a machine");
  EXPECT_TRUE(row.reason.empty());
}

TEST(ReportRow, TakesTheFormerWordsOfOlderReports) {
  const auto quantities = [](const char* text) {
    return row_of_report(Json::parse(text)).quantities;
  };
  EXPECT_EQ(quantities(R"({"evidence": {"front": {"delay": -0.1}}})"),
            quantities(R"({"comparison": {"front": {"delay": -0.1}}})"));
  EXPECT_EQ(quantities(R"({"series_evidence": {"curves": [{"sensor": "a", "mean": 2}]}})"),
            quantities(R"({"series_comparison": {"curves": [{"sensor": "a", "mean": 2}]}})"));
  EXPECT_EQ(quantities(R"({"evidence": {"front": {"delay": -0.1}}})").size(), 1u);
}

TEST(ReportRow, OfAReportWithoutAnErrorSaysWhyThereIsNone) {
  const StudyRow row = row_of_report(Json::parse(R"({"error": null})"));
  EXPECT_FALSE(row.error);
  EXPECT_NE(row.reason.find("no reference"), std::string::npos);
}

TEST(ReportRow, OfAnythingElseIsEmptyAndNoCrash) {
  for (const char* text : {"null", "[]", "3", "\"x\"", R"({"error": "x", "comparison": "x"})",
                           R"({"comparison": {"pressures": {"a": 1}}, "cost": []})",
                           R"({"series_comparison": {"curves": [1, null, "x"]}})"}) {
    EXPECT_FALSE(row_of_report(Json::parse(text)).error) << text;
  }
}

}  // namespace
}  // namespace sluice
