// Particles that leave a run: what the guards make of them, and who hears of it.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/run/events.hpp"
#include "engine/run/removal_news.hpp"
#include "engine/run/simulation.hpp"
#include "engine/scene/checks/parse.hpp"
#include "engine/scene/geometry/leaks.hpp"
#include "tests/run/scenes.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;
using testing::small_dam_break;

constexpr const char* kRecommended = R"({"kernel": "wendland_c2", "integrator": "kick_drift_kick",
  "courant": 1.0, "density_diffusion": {"kind": "fourtakas", "delta": 0.1},
  "artificial_viscosity": {"alpha": 0.02, "beta": 0.5}, "wall_shear": {"coefficient": 0.01},
  "wall_pressure": "clamped", "particle_shifting": {"coefficient": 2}})";

/// Water in a tank that brakes: it leaves over the rim towards which it is pulled.
Scene braking_tank(double pull) {
  Json scene{{"name", "braking-tank"},
             {"tank", {{"width", 4.0}, {"height", 0.5}}},
             {"gravity", {pull, -9.81}},
             {"resolution", {{"spacing", 0.05}, {"smoothing_ratio", 1.5}}},
             {"numerics", Json::parse(kRecommended)},
             {"end_time", 3.0}};
  scene["fluid"] =
      Json::array({{{"shape", "rectangle"}, {"corner", {0.0, 0.0}}, {"size", {4.0, 0.45}}}});
  return *parse_scene(scene.dump(), StabilityCheck::skip).scene;
}

TEST(EnergyGuard, DoesNotDependOnTheSideOnWhichWaterLeaves) {
  std::size_t left[2];
  for (const int side : {0, 1}) {
    Simulation simulation(braking_tank(side == 0 ? 3.0 : -3.0), {1, ""});
    ASSERT_NO_THROW({
      while (!simulation.finished()) simulation.step();
    }) << "pulled to the "
       << (side == 0 ? "right" : "left");
    left[side] = simulation.overtopped();
    EXPECT_GT(left[side], 50U) << "hardly any water left: this test proves nothing";
    EXPECT_EQ(simulation.excluded(), 0U);
  }
  EXPECT_NEAR(static_cast<double>(left[0]), static_cast<double>(left[1]), 0.1 * 720);
}

TEST(EnergyGuard, DoesNotDependOnTheOrigin) {
  Method method;
  method.spacing = 0.1;
  method.reference_density = 1000.0;
  method.sound_speed = 20.0;
  method.gravity = Vec2(3.0, -9.81);
  std::vector<double> growths;
  for (const Vec2& origin : {Vec2(0.0, 0.0), Vec2(1000.0, -2000.0), Vec2(-1000.0, 500.0)}) {
    const double weight = method.particle_mass();
    SolverState state;
    Energy energy;
    for (const Vec2& place : {Vec2(0.0, 0.0), Vec2(1.0, 1.0), Vec2(2.0, 0.5)}) {
      append(state.particles.position, Vec2(place + origin));
      energy.potential -= weight * method.gravity.dot(place + origin);
    }
    const GuardBaselines base = initial_baselines(method, state, energy);
    // The third leaves as it is: nothing has grown.
    RemovedParticle third;
    third.cause = RemovalCause::overtopped;
    third.position = state.particles.position_of(2);
    const double gone = energy_that_left(method, third);
    const double still = energy.potential + weight * method.gravity.dot(Vec2(2.0, 0.5) + origin);
    growths.push_back((still + gone - base.initial_energy) / base.energy_scale);
  }
  for (const double growth : growths) EXPECT_NEAR(growth, 0.0, 1e-9);
}

/// The state at a step with particles made as fast as they may be, so that some are too fast soon.
Checkpoint with_fast_ones(const Scene& scene, std::size_t count) {
  Simulation simulation(scene, {1, ""});
  for (int n = 0; n < 10; ++n) simulation.step();
  Checkpoint kept = simulation.checkpoint();
  Particles& p = kept.solver.particles;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = k * p.size() / count;
    p.density_excess[i] = 0.2999 * scene.method.reference_density;
    if (!p.density_excess_half.empty()) p.density_excess_half[i] = p.density_excess[i];
    p.velocity[0][i] = 0.999 * scene.method.sound_speed;
    if (!p.velocity_half[0].empty()) p.velocity_half[0][i] = p.velocity[0][i];
  }
  return kept;
}

/// Keeps the names of events.
class Listener final : public Reporter {
 public:
  void progress(const Progress&) override {}
  void event(const RunEvent& event) override {
    names.emplace_back(to_string(event.kind));
    messages.push_back(event.message());
  }
  std::vector<std::string> names;
  std::vector<std::string> messages;
};

TEST(Exclusion, OfOneParticleEndsNoRunAndIsToldOnceWithItsPlace) {
  for (const char* integrator : {"modified_leap_frog", "kick_drift_kick"}) {
    testing::SmallScene choice;
    choice.integrator = integrator;
    const Scene scene = small_dam_break(choice);
    Simulation simulation(scene, {1, ""}, with_fast_ones(scene, 1));
    Listener listener;
    RemovalNews news(simulation);
    ASSERT_NO_THROW({
      while (!simulation.finished()) {
        simulation.step();
        news.tell(simulation, listener);
      }
    });
    ASSERT_GE(simulation.excluded(), 1U);
    EXPECT_LE(simulation.excluded(), 8U);
    EXPECT_EQ(std::count(listener.names.begin(), listener.names.end(), "excluded"),
              static_cast<std::ptrdiff_t>(simulation.excluded()));
    const RemovedParticle first = simulation.solver().removed(0);
    EXPECT_NE(listener.messages[0].find("step " + std::to_string(first.step)), std::string::npos);
    EXPECT_NE(listener.messages[0].find("limit"), std::string::npos);
    EXPECT_EQ(simulation.solver().particle_count() + simulation.solver().removed_count(), 400U);
  }
}

TEST(Exclusion, OfManyEndsTheRunAtTheSameStepHoweverOftenItIsResumed) {
  const Scene scene = small_dam_break();
  const Checkpoint start = with_fast_ones(scene, 40);
  const auto failing_step = [&](bool resumed) {
    Simulation simulation(scene, {1, ""}, start);
    try {
      while (!simulation.finished()) {
        simulation.step();
        if (resumed) simulation = Simulation(scene, {2, ""}, simulation.checkpoint());
      }
    } catch (const NumericalFailure& failure) {
      EXPECT_NE(failure.diagnosis().reason.find("excluded"), std::string::npos);
      return failure.diagnosis().step;
    }
    return std::uint64_t{0};
  };
  const std::uint64_t straight = failing_step(false);
  EXPECT_GT(straight, 0U);
  EXPECT_EQ(failing_step(true), straight);
}

TEST(Exclusion, OfAllAtTheStartRefusesTheScene) {
  Scene scene = small_dam_break();
  scene.fluid[0].velocity = Vec2(0.0, 1.1 * scene.method.sound_speed);
  EXPECT_THROW(Simulation(scene, {1, ""}), NumericalFailure);
}

/// Water beside an obstacle from the floor to the rim, of a job that was taken before such an
/// obstacle was refused.
Scene baffle(Json obstacle) {
  Json scene{{"name", "baffle"},
             {"tank", {{"width", 0.614}, {"height", 0.4}}},
             {"gravity", {0.0, -9.81}},
             {"resolution", {{"spacing", 0.01}, {"smoothing_ratio", 1.5}}},
             {"numerics", Json::parse(kRecommended)},
             {"end_time", 1.5}};
  scene["fluid"] =
      Json::array({{{"shape", "rectangle"}, {"corner", {0.0, 0.0}}, {"size", {0.27, 0.3}}}});
  scene["obstacles"] = Json::array({std::move(obstacle)});
  return *parse_scene(scene.dump(), StabilityCheck::skip, SceneOrigin::job).scene;
}

void expect_to_leak(const Scene& scene) {
  Simulation simulation(scene, {1, ""});
  EXPECT_THROW(
      {
        while (!simulation.finished()) simulation.step();
      },
      NumericalFailure);
  EXPECT_GT(simulation.leaked(), 8U);
}

TEST(Leaks, ThroughAnObstacleThatIsTooThinAreCountedAndEndTheRun) {
  // 1.4 spacings thick: it holds nothing back.
  expect_to_leak(baffle({{"shape", "rectangle"}, {"corner", {0.27, 0.0}}, {"size", {0.014, 0.4}}}));
}

TEST(Leaks, ThroughTheThinEndOfAWedgeAreCountedAndEndTheRun) {
  // Of 8 degrees: less than two spacings thick up to 0.14 m above the tip.
  expect_to_leak(
      baffle({{"shape", "polygon"}, {"points", {{0.3, 0.0}, {0.328, 0.4}, {0.272, 0.4}}}}));
}

TEST(Leaks, AreCountedWhereAnObstacleIsThinAndNotWhereOneIsThick) {
  // A wedge on its tip in a tank whose floor is below it: 0.12 m thick per metre above the tip.
  Scene scene = small_dam_break();
  const double dx = scene.method.spacing;
  const double width_per_height = 0.12;
  Polygon wedge;
  wedge.points = {Vec2(0.3, 0.0), Vec2(0.3 + 0.06 * 0.3, 0.3), Vec2(0.3 - 0.06 * 0.3, 0.3)};
  scene.obstacles = {wedge};
  const FlowDomain domain = domain_with_solids(scene);
  const auto middle_is_deep = [&](double thickness) {
    return domain.in_solid(Vec2(0.3, thickness * dx / width_per_height), 0.0);
  };
  for (const double spacings : {0.9, 1.2, 2.0, 3.0, 4.0})
    EXPECT_TRUE(middle_is_deep(spacings)) << spacings;
  // 0.7 spacings deep is beyond 0.6 of the half of what is two spacings thick, not of three.
  const auto is_deep = [&](double thickness) {
    const double y = thickness * dx / width_per_height;
    return domain.in_solid(Vec2(0.3 + (0.5 * thickness - 0.7) * dx, y), 0.0);
  };
  EXPECT_TRUE(is_deep(2.0));
  EXPECT_FALSE(is_deep(3.0));
}

TEST(Leaks, AreNoneInTheToeOfARampForTheFloorIsBelow) {
  Scene scene = small_dam_break();
  const double dx = scene.method.spacing;
  Polygon ramp;
  ramp.points = {Vec2(0.2, 0.0), Vec2(0.4, 0.0), Vec2(0.4, 0.02)};
  scene.obstacles = {ramp};
  const FlowDomain domain = domain_with_solids(scene);
  // On the ramp's surface: 0.1 (x - 0.2).
  const double x = 0.35;
  const double surface = 0.1 * (x - 0.2);
  EXPECT_FALSE(domain.in_solid(Vec2(x, surface - 0.9 * dx), 0.0));
  EXPECT_TRUE(domain.in_solid(Vec2(x, surface - 1.1 * dx), 0.0));
}

TEST(Leaks, AreNoneInATipRoundWhichFluidFlows) {
  Scene scene = small_dam_break();
  const double dx = scene.method.spacing;
  Polygon wedge;  // of 60 degrees
  wedge.points = {Vec2(0.2, 0.0), Vec2(0.4, 0.0), Vec2(0.3, 0.1 * std::sqrt(3.0))};
  scene.obstacles = {wedge};
  const FlowDomain domain = domain_with_solids(scene);
  // On its axis a place is half as deep as it is below the tip.
  const auto is_deep = [&](double depth) {
    return domain.in_solid(Vec2(0.3, 0.1 * std::sqrt(3.0) - 2.0 * depth * dx), 0.0);
  };
  for (const double spacings : {0.1, 0.45, 0.7, 0.95}) EXPECT_FALSE(is_deep(spacings)) << spacings;
  for (const double spacings : {1.05, 2.0}) EXPECT_TRUE(is_deep(spacings)) << spacings;
}

TEST(Leaks, AreCountedBetweenPlatesThatLieSideBySide) {
  Scene scene = small_dam_break();
  const double dx = scene.method.spacing;
  scene.obstacles = {Rectangle{Vec2(0.2, 0.0), Vec2(dx, 0.2)},
                     Rectangle{Vec2(0.2 + dx, 0.0), Vec2(dx, 0.2)}};
  const FlowDomain domain = domain_with_solids(scene);
  EXPECT_TRUE(domain.in_solid(Vec2(0.2 + dx, 0.1), 0.0)) << "in the middle of two spacings";
  EXPECT_FALSE(domain.in_solid(Vec2(0.2 + 0.5 * dx, 0.1), 0.0)) << "in the first row";
}

}  // namespace
}  // namespace sluice
