#include "engine/report/reference.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/report/comparison.hpp"
#include "sluice/reference_texts.hpp"

namespace sluice {
namespace {

const Reference& lobovsky() {
  for (const Reference& reference : references()) {
    if (reference.name == "lobovsky2014_h300") return reference;
  }
  throw std::runtime_error("not built in");
}

std::string text_of(std::string_view name) {
  for (const auto& [stem, text] : kReferenceTexts) {
    if (stem == name) return std::string(text);
  }
  throw std::runtime_error("not built in");
}

Scene paper_scene() {
  Scene scene;
  scene.tank = Tank{1.61, 0.6, {}, true};
  scene.scales = Scales{0.3, 0.6};
  scene.method.gravity = Vec2(0.0, -9.81);
  return scene;
}

TEST(References, HoldTheExperimentWithItsFourSensorsFourLevelsAndFront) {
  const Reference& reference = lobovsky();
  ASSERT_EQ(reference.pressures.size(), 4u);
  EXPECT_EQ(reference.pressures[0].name, "P1");
  EXPECT_DOUBLE_EQ(reference.pressures[0].place.y(), 0.003);
  EXPECT_DOUBLE_EQ(reference.pressures[0].arrival, 2.443);
  EXPECT_DOUBLE_EQ(reference.pressures[0].peak.median, 3.116);
  ASSERT_EQ(reference.levels.size(), 4u);
  EXPECT_EQ(reference.front.time.back(), 2.4) << "the last point of the figure has no value";
  EXPECT_NE(reference.citation.find("10.1016/j.jfluidstructs.2014.03.009"), std::string::npos);
}

TEST(References, AverageTheTestsOfALevel) {
  const Reference& reference = lobovsky();
  EXPECT_EQ(reference.levels[1].name, "H2");
  EXPECT_DOUBLE_EQ(reference.levels[1].values[5], 0.5 * (0.0145 + 0.0229));
}

TEST(References, ShowTheSecondRiseOfTheExperimentNearSix) {
  // "At about T = 6, there is a slight pressure rise in the experimental data."
  const Reference& reference = lobovsky();
  for (const PressureReference& sensor : reference.pressures) {
    const auto rise =
        second_rise(reference.pressure_times, sensor.values, reference.measures.second_rise);
    ASSERT_TRUE(rise) << sensor.name;
    EXPECT_NEAR(rise->time, 5.95, 0.05) << sensor.name;
  }
}

TEST(References, DifferBetweenTheEventAndTheMedianOfTheTestsByNinePercentAtP2) {
  const Reference& reference = lobovsky();
  const auto file = nlohmann::json::parse(text_of("lobovsky2014_h300"));
  const auto median = file.at("P2_band").at("median").get<std::vector<double>>();
  const auto distance = relative_l2(reference.pressure_times, median, reference.pressures[1].values,
                                    reference.measures.comparison);
  EXPECT_NEAR(*distance, 0.09, 0.005);
}

TEST(References, MatchASceneOfTheSameShapeAtAnySize) {
  Scene scene = paper_scene();
  ASSERT_NE(matching_reference(scene), nullptr);
  EXPECT_EQ(matching_reference(scene)->name, "lobovsky2014_h300");
  scene.tank = Tank{16.1, 6.0, {}, true};
  scene.scales = Scales{3.0, 6.0};
  EXPECT_NE(matching_reference(scene), nullptr);
}

TEST(References, DoNotMatchAnotherShapeOrASceneWithoutTankGravityOrScales) {
  Scene wide = paper_scene();
  wide.tank->width = 2.0;
  Scene narrow_column = paper_scene();
  narrow_column.scales->width = 0.3;
  Scene no_tank = paper_scene();
  no_tank.tank.reset();
  Scene no_gravity = paper_scene();
  no_gravity.method.gravity = Vec2::Zero();
  Scene no_scales = paper_scene();
  no_scales.scales.reset();
  for (const Scene& scene : {wide, narrow_column, no_tank, no_gravity, no_scales}) {
    EXPECT_EQ(matching_reference(scene), nullptr);
  }
}

TEST(References, ThatAreBrokenAreRefusedByName) {
  auto file = nlohmann::json::parse(text_of("lobovsky2014_h300"));
  file["event"]["P1"].erase(0);
  try {
    (void)parse_reference("broken", file.dump());
    FAIL() << "was accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("broken"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("P1"), std::string::npos);
  }
  EXPECT_THROW((void)parse_reference("empty", "{}"), std::runtime_error);
  EXPECT_THROW((void)parse_reference("no text", "{"), std::runtime_error);
}

}  // namespace
}  // namespace sluice
