#include "engine/study/report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/store/errors.hpp"

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

TEST(Report, SaysThatNoExperimentMatchesAndThatTheRunHasNotEnded) {
  const Report report = make_report(scene_of_no_experiment(), {probe()}, nullptr);
  EXPECT_FALSE(report.evidence);
  const std::string text = report_text(report);
  EXPECT_NE(text.find("no experiment"), std::string::npos);
  EXPECT_NE(text.find("has not ended"), std::string::npos);
  EXPECT_TRUE(report_json(report).at("evidence").is_null());
  EXPECT_TRUE(report_json(report).at("outcome").is_null());
}

TEST(Report, SurvivesAnOutcomeOfAnotherLayout) {
  for (const char* text : {"3", "[]", "{}", R"({"this_attempt": 3, "retired": [], "state": 1})",
                           R"({"this_attempt": {"passes": [1, {"name": 2}, {"seconds": "x"}]}})"}) {
    const auto outcome = nlohmann::ordered_json::parse(text);
    EXPECT_FALSE(report_text(make_report(scene_of_no_experiment(), {}, outcome)).empty()) << text;
  }
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
