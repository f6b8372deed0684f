#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/run/simulation.hpp"
#include "engine/scene/checks/parse.hpp"

namespace sluice {
namespace {

using nlohmann::json;

/// Still water of 0.3 m at dx = 0.01 m, the recommended scheme; two sensors on the bed.
json still_water(double width, json fluid, json obstacles) {
  json scene = json::parse(R"({
    "name": "still", "gravity": [0, -9.81],
    "resolution": {"spacing": 0.01, "smoothing_ratio": 1.5},
    "numerics": {"kernel": "wendland_c2", "integrator": "kick_drift_kick", "courant": 1.0,
      "density_diffusion": {"kind": "fourtakas", "delta": 0.1},
      "artificial_viscosity": {"alpha": 0.02, "beta": 0.5}, "wall_shear": {"coefficient": 0.01},
      "wall_pressure": "clamped", "particle_shifting": {"coefficient": 2}},
    "end_time": 0.55})");
  scene["tank"] = {{"width", width}, {"height", 0.4}};
  scene["fluid"] = std::move(fluid);
  if (!obstacles.is_null()) scene["obstacles"] = std::move(obstacles);
  return scene;
}

json rectangle(double x, double y, double width, double height) {
  return {{"shape", "rectangle"}, {"corner", {x, y}}, {"size", {width, height}}};
}

json polygon(json points) { return {{"shape", "polygon"}, {"points", std::move(points)}}; }

/// Runs to about three times sqrt(h0/g), h0 the water's level. Eq. 11 on a flat bed reads the
/// pressure of the middle of half a kernel, 4/(3 pi) h above it; errors are shares of rho_0 g h.
void expect_calm(const json& text, const Vec2& sensor, double area, double level = 0.3) {
  const ParseResult parsed = parse_scene(text.dump());
  ASSERT_TRUE(parsed.scene);
  const Scene& scene = *parsed.scene;
  Simulation simulation(scene, {1, ""});
  const auto particles = static_cast<double>(simulation.solver().particle_count());
  EXPECT_NEAR(particles * 1e-4, area, 0.005 * area);

  const double h = scene.method.smoothing_length;
  const double full = 9810.0 * (level - sensor.y());
  const double right = full - 9810.0 * 4.0 / (3.0 * std::numbers::pi) * h;
  const double unit = std::sqrt(level / 9.81);
  double sum = 0.0, time = 0.0, heights = 0.0;
  EXPECT_NEAR(simulation.solver().pressure_at(sensor, h).value, right, 0.01 * full);
  while (!simulation.finished()) {
    simulation.step();
    const Solver& solver = simulation.solver();
    const double pressure = solver.pressure_at(sensor, h).value;
    ASSERT_NEAR(pressure, right, 0.05 * full) << "at " << solver.time() << " s";
    if (solver.time() < unit) continue;
    sum += solver.time_step() * pressure;
    heights += solver.time_step() * solver.surface_height_at(sensor).value;
    time += solver.time_step();
  }
  EXPECT_NEAR(sum / time, right, 0.0125 * full);
  EXPECT_NEAR(heights / time, level, 0.005 * level);
}

TEST(CalmStart, OverASlope) {
  expect_calm(still_water(0.8, {polygon({{0, 0}, {0.4, 0}, {0.8, 0.2}, {0.8, 0.3}, {0, 0.3}})},
                          {polygon({{0.4, 0}, {0.8, 0}, {0.8, 0.2}})}),
              Vec2(0.2, 0), 0.8 * 0.3 - 0.04);
}

TEST(CalmStart, AroundACircle) {
  const json circle = {{"shape", "circle"}, {"center", {0.3, 0.13}}, {"radius", 0.06}};
  expect_calm(still_water(0.6, {rectangle(0, 0, 0.6, 0.3)}, {circle}), Vec2(0.3, 0),
              0.18 - std::numbers::pi * 0.0036);
}

TEST(CalmStart, OverSteps) {
  expect_calm(still_water(0.8, {rectangle(0, 0, 0.8, 0.3)},
                          {rectangle(0.403, 0, 0.2, 0.056), rectangle(0.603, 0, 0.197, 0.103)}),
              Vec2(0.2, 0), 0.24 - 0.0112 - 0.197 * 0.103);
}

TEST(CalmStart, InATankThatIsNoMultipleOfTheSpacing) {
  expect_calm(still_water(0.604, {rectangle(0, 0, 0.604, 0.3)}, {}), Vec2(0.3, 0), 0.604 * 0.3);
}

TEST(CalmStart, OverARaisedBedOffTheLattice) {
  const json outline = {{0, 0}, {0.6, 0}, {0.6, 0.055}, {0, 0.055}};
  for (const json& bed : {rectangle(0, 0, 0.6, 0.055), polygon(outline)}) {
    expect_calm(still_water(0.6, {rectangle(0, 0.055, 0.6, 0.3)}, {bed}), Vec2(0.3, 0.055), 0.18,
                0.355);
  }
}

TEST(CalmStart, OverASlopingBed) {
  expect_calm(still_water(0.6, {polygon({{0, 0.05}, {0.6, 0.08}, {0.6, 0.3}, {0, 0.3}})},
                          {polygon({{0, 0}, {0.6, 0}, {0.6, 0.08}, {0, 0.05}})}),
              Vec2(0.1, 0.055), 0.3 * (0.25 + 0.22));
}

TEST(CalmStart, BesideAWallOffTheLattice) {
  expect_calm(still_water(0.655, {rectangle(0.055, 0, 0.6, 0.3)}, {rectangle(0, 0, 0.055, 0.4)}),
              Vec2(0.3, 0), 0.18);
}

TEST(CalmStart, OfTwoRegionsThatMakeAnL) {
  expect_calm(still_water(0.6, {rectangle(0, 0, 0.304, 0.154), rectangle(0, 0.154, 0.6, 0.146)},
                          {rectangle(0.304, 0, 0.296, 0.154)}),
              Vec2(0.15, 0), 0.304 * 0.154 + 0.6 * 0.146);
}

TEST(CalmStart, OfStackedRegions) {
  expect_calm(still_water(0.6, {rectangle(0, 0, 0.6, 0.15), rectangle(0, 0.15, 0.6, 0.15)}, {}),
              Vec2(0.3, 0), 0.18);
}

TEST(CalmStart, IsReportedWhereParticlesWerePacked) {
  const json off = still_water(0.604, {rectangle(0, 0, 0.604, 0.3)}, {});
  const Simulation packed(*parse_scene(off.dump()).scene, {1, ""});
  ASSERT_TRUE(packed.packing());
  EXPECT_GT(packed.packing()->iterations, 1);
  const Simulation again(packed.scene(), {2, ""});
  EXPECT_EQ(again.solver().state().particles.position[0],
            packed.solver().state().particles.position[0]);
  const Simulation resumed(packed.scene(), {1, ""}, packed.checkpoint());
  EXPECT_FALSE(resumed.packing()) << "a restart makes walls alone";
  EXPECT_EQ(resumed.solver().wall_count(), packed.solver().wall_count());
}

}  // namespace
}  // namespace sluice
