#include "engine/report/comparison.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sluice {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// A dam break half the experiment's size on a light planet with a light fluid: only the
/// dimensionless shape is the same.
Scene half_size_scene() {
  Scene scene;
  scene.tank = Tank{0.805, 0.3, {}, true};
  scene.scales = Scales{0.15, 0.3};
  scene.method.gravity = Vec2(0.0, -1.6);
  scene.method.reference_density = 800.0;
  scene.method.smoothing_length = 0.0015;
  Sensor wall;
  wall.name = "low";
  wall.position = Vec2(0.805, 0.0015);
  wall.smoothing_length = 0.0015;
  Sensor level;
  level.name = "surface";
  level.kind = SensorKind::surface_height;
  level.position = Vec2(0.15, 0.0);
  Sensor front;
  front.name = "tip";
  front.kind = SensorKind::surge_front;
  scene.sensors = {wall, level, front};
  return scene;
}

double unit_of_time(const Scene& scene) { return std::sqrt(scene.scales->height / 1.6); }
double unit_of_pressure(const Scene& scene) { return 800.0 * 1.6 * scene.scales->height; }

/// Dry until T = 2.5, up to 1 at 2.6, level, from 6.0 up to 1.5 at 6.4.
double impact(double t) {
  return std::clamp(10.0 * (t - 2.5), 0.0, 1.0) + 0.5 * std::clamp((t - 6.0) / 0.4, 0.0, 1.0);
}

template <typename Function>
Curve curve_of(Function&& function) {
  Curve curve;
  for (int i = 0; i <= 8000; ++i) {
    curve.time.push_back(1e-3 * i);
    curve.value.push_back(function(1e-3 * i));
  }
  return curve;
}

template <typename Function>
Series series_of(const Scene& scene, const std::string& name, const std::string& kind, double unit,
                 Function&& function) {
  const Curve curve = curve_of(function);
  Series series;
  series.name = name;
  series.kind = kind;
  series.columns = {{"value", kind == "pressure" ? "Pa" : "m"}};
  for (std::size_t n = 0; n < curve.size(); ++n) {
    series.time.push_back(curve.time[n] * unit_of_time(scene));
    series.duration.push_back(n == 0 ? 0.0 : 1e-3 * unit_of_time(scene));
    series.values.push_back(curve.value[n] * unit);
    series.weight.push_back(std::isnan(curve.value[n]) ? 0.0 : 1.0);
  }
  return series;
}

std::vector<double> tenths(double from, double to) {
  std::vector<double> times;
  for (int i = 0; from + 0.1 * i < to + 0.05; ++i) times.push_back(from + 0.1 * i);
  return times;
}

/// The experiment that `impact` would be, with one pressure sensor, one level and a front.
Reference made_up_reference() {
  const Intervals pressure_times(tenths(2.0, 7.0));
  const Intervals level_times(tenths(0.0, 6.0));
  PressureReference wall;
  wall.name = "P1";
  wall.place = {1.61, 0.003};
  wall.arrival = 2.505;
  wall.values = interval_averages(curve_of(impact), pressure_times);
  wall.peak = {1.0, 0.5, 1.5};
  LevelReference level{"H1", Vec2(0.3, 0.0), std::vector<double>(level_times.size(), 0.5)};
  return {.name = "made_up",
          .title = "",
          .citation = "",
          .height = 0.3,
          .width = 0.6,
          .tank_width = 1.61,
          .tank_height = 0.6,
          .pressure_times = pressure_times,
          .pressures = {wall},
          .level_times = level_times,
          .levels = {level},
          .front = Curve{{0.0, 1.0, 2.0}, {0.0, 1.5, 3.0}},
          .peak_tests = 1,
          .measures = {.arrival = 0.05,
                       .comparison = {2.3, 7.05},
                       .impact = {2.3, 5.0},
                       .plateau = {3.5 - 1e-9, 5.0 + 1e-9},
                       .second_rise = {{5.0 - 1e-9, 5.65}, {5.65, 7.05}},
                       .pictures = {2.0, 5.9, 7.8},
                       .front_axis = {0.0, 3.0},
                       .pressure_axis = {2.0, 8.0}}};
}

Comparison compare_with_delay(double delay, double factor) {
  const Scene scene = half_size_scene();
  static const Reference reference = made_up_reference();
  const auto late = [&](double t) {
    const double value = factor * impact(t - delay);
    return value == 0.0 ? kNoValue : value;
  };
  return compare(scene, {series_of(scene, "low", "pressure", unit_of_pressure(scene), late)},
                 reference, 2e-3 * unit_of_time(scene));
}

TEST(Comparison, OfARunThatEqualsTheExperimentIsNoError) {
  const Comparison comparison = compare_with_delay(0.0, 1.0);
  ASSERT_EQ(comparison.pressures.size(), 1u);
  EXPECT_EQ(comparison.pressures[0].sensor, "low");
  EXPECT_EQ(comparison.pressures[0].reference, "P1");
  EXPECT_NEAR(*comparison.mean_relative_l2, 0.0, 1e-3);
  EXPECT_NEAR(*comparison.shift, 0.0, 1e-3);
}

TEST(Comparison, IsTheSameForARunThatIsLateAndReportsTheShift) {
  const Comparison comparison = compare_with_delay(0.3, 1.0);
  EXPECT_NEAR(*comparison.shift, -0.3, 1e-3);
  EXPECT_NEAR(*comparison.mean_relative_l2, 0.0, 1e-3);
  EXPECT_NEAR(*comparison.pressures[0].simulation.arrival, 2.505, 1e-12);
  // The ramp's upper knee averages to 1.5 - 0.05 * 0.0625 / 2 / 0.1 over [6.35, 6.45].
  EXPECT_NEAR(comparison.pressures[0].simulation.second_rise->time,
              6.3 + 0.1 * (1.45 - 1.375) / (1.484375 - 1.375), 1e-3);
}

TEST(Comparison, OfPressuresTooHighByAFifthIsAFifth) {
  const Comparison comparison = compare_with_delay(0.0, 1.2);
  const PressureComparison& wall = comparison.pressures[0];
  EXPECT_NEAR(*wall.relative_l2, 0.2, 2e-3);
  EXPECT_NEAR(wall.simulation.peak->value, 1.2, 1e-9);
  EXPECT_NEAR(*wall.place_in_band(), 0.7, 1e-9) << "1.2 between 0.5 and 1.5";
  EXPECT_NEAR(*wall.simulation.plateau, 1.2, 1e-9);
  EXPECT_NEAR(*wall.experiment.plateau, 1.0, 1e-9);
  EXPECT_NEAR(*wall.simulation.impulse / *wall.experiment.impulse, 1.2, 2e-3);
  EXPECT_NEAR(wall.simulation.second_rise->height, 1.8, 1e-6);
}

TEST(Comparison, HasNoErrorAndNoShiftWhereNothingArrives) {
  const Comparison comparison = compare_with_delay(0.0, 0.0);
  EXPECT_FALSE(comparison.shift);
  EXPECT_FALSE(comparison.mean_relative_l2);
  EXPECT_FALSE(comparison.pressures[0].simulation.arrival);
}

TEST(Comparison, HasNoMeanWhereASensorOfTheExperimentIsMissing) {
  const Scene scene = half_size_scene();
  Reference reference = made_up_reference();
  reference.pressures.push_back(reference.pressures.front());
  reference.pressures.back().place.y() = 0.08;
  const Comparison comparison = compare(
      scene, {series_of(scene, "low", "pressure", unit_of_pressure(scene), impact)}, reference);
  EXPECT_EQ(comparison.pressures.size(), 1u);
  EXPECT_TRUE(comparison.pressures[0].relative_l2);
  EXPECT_FALSE(comparison.mean_relative_l2);
}

TEST(Comparison, HasNoErrorForARunThatEndsInsideTheWindow) {
  const Scene scene = half_size_scene();
  Series series = series_of(scene, "low", "pressure", unit_of_pressure(scene), impact);
  for (auto* column : {&series.time, &series.duration, &series.values, &series.weight}) {
    column->resize(6000);
  }
  const Reference reference = made_up_reference();
  const Comparison comparison = compare(scene, {series}, reference);
  EXPECT_FALSE(comparison.pressures[0].relative_l2);
  EXPECT_TRUE(comparison.pressures[0].simulation.plateau) << "the plateau was reached";
}

TEST(Comparison, ComparesLevelsAndFrontWithoutAShift) {
  const Scene scene = half_size_scene();
  const Reference reference = made_up_reference();
  const double height = scene.scales->height;
  const Comparison comparison =
      compare(scene,
              {series_of(scene, "surface", "surface_height", height, [](double) { return 0.6; }),
               // The front of the reference, a quarter of T later: X = w0/h0 + 1.5 (T - 0.25).
               series_of(scene, "tip", "surge_front", height,
                         [](double t) { return 2.0 + 1.5 * std::max(t - 0.25, 0.0); })},
              reference);
  ASSERT_EQ(comparison.levels.size(), 1u);
  EXPECT_NEAR(*comparison.levels[0].rms_difference, 0.1, 1e-9);
  ASSERT_TRUE(comparison.front);
  EXPECT_NEAR(*comparison.front->delay, 0.25, 1e-9);
  EXPECT_FALSE(comparison.shift);
}

TEST(PressureCurve, CountsDrySamplesAsZeroSoThatTheFilterDoesNotBringTheArrivalForward) {
  // A step from dry to 1 filtered by eq. 12 is (1 + erf((t - t0)/tau))/2: 0.05 at t0 - 1.1631 tau.
  const Scene scene = half_size_scene();
  const double tau = 0.05 * unit_of_time(scene);
  const Series step = series_of(scene, "low", "pressure", unit_of_pressure(scene),
                                [](double t) { return t < 3.0 ? kNoValue : 1.0; });
  const auto arrival = first_passage(pressure_curve(step, scene, tau), 0.05, 0.0);
  EXPECT_NEAR(*arrival, 3.0 - 1.1631 * 0.05, 1e-3);
}

}  // namespace
}  // namespace sluice
