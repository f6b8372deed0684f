// Scenes of three dimensions: from their text to a run that resumes exactly.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/run/simulation.hpp"
#include "engine/scene/checks/parse.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/digest.hpp"

namespace sluice {
namespace {

Scene parsed(const std::string& text) {
  const ParseResult result = parse_scene(text);
  for (const Problem& problem : result.problems) {
    ADD_FAILURE() << problem.pointer << ": " << problem.message;
  }
  return result.scene.value();
}

/// A column that meets a box, a gate and every kind of sensor.
Scene dam_break(const std::string& precision) {
  return parsed(R"({
    "name": "dam-break-in-space",
    "tank": {"width": 0.6, "height": 0.4, "depth": 0.24},
    "gate": {"x": 0.2, "height": 0.3, "speed": 3},
    "fluid": [{"shape": "box", "corner": [0, 0, 0], "size": [0.2, 0.2, 0.24]}],
    "obstacles": [{"shape": "box", "corner": [0.44, 0, 0.04], "size": [0.1, 0.1, 0.1]}],
    "gravity": [0, -9.81, 0],
    "resolution": {"spacing": 0.02},
    "numerics": {"scheme": "recommended", "precision": ")" +
                precision + R"("},
    "sensors": [
      {"name": "P", "kind": "pressure", "position": [0.44, 0.02, 0.1], "interval": 0},
      {"name": "face", "kind": "pressure", "position": [0.44, 0.02, 0.1], "air_pressure": 0, "interval": 0},
      {"name": "H", "kind": "surface_height", "x": 0.1, "z": 0.12, "interval": 0},
      {"name": "column", "kind": "column_height", "interval": 0},
      {"name": "front", "kind": "surge_front", "interval": 0},
      {"name": "arrival", "kind": "arrival", "position": [0.44, 0.02, 0.1], "interval": 0},
      {"name": "energy", "kind": "energy", "interval": 0}
    ],
    "end_time": 0.25
  })");
}

void run_to_step(Simulation& simulation, std::uint64_t step) {
  while (simulation.solver().step_count() < step) simulation.step();
}

std::string digest_of(const Simulation& simulation) {
  std::string digest = physics_digest(simulation.checkpoint());
  for (const Series& series : split(simulation.samples())) digest += series_digest(series);
  return digest;
}

TEST(SpaceRun, ResumesFromItsCheckpointsToTheSameBitsWithAnyThreads) {
  constexpr std::uint64_t kEnd = 90;
  for (const std::string precision : {"mixed", "double"}) {
    const Scene scene = dam_break(precision);
    Simulation whole(scene, {1, ""});
    run_to_step(whole, kEnd);
    Simulation first(scene, {2, ""});
    run_to_step(first, 41);
    const Bytes image = encode_checkpoint(first.checkpoint());
    Simulation second(scene, {1, ""}, decode_checkpoint(image, identity_of(scene)));
    run_to_step(second, 66);
    const Bytes later = encode_checkpoint(second.checkpoint());
    Simulation third(scene, {2, ""}, decode_checkpoint(later, identity_of(scene)));
    EXPECT_TRUE(third.bit_exact());
    run_to_step(third, kEnd);
    EXPECT_EQ(digest_of(third), digest_of(whole)) << precision;
  }
}

TEST(SpaceRun, LosesNobodyWithoutATankAndUnderALid) {
  const Scene ball = parsed(R"({
    "name": "ball",
    "fluid": [{"shape": "sphere", "center": [0, 0, 0], "radius": 0.1, "velocity": [1, 0.5, 0.25],
               "pressure": "zero"}],
    "material": {"density": 1000, "sound_speed": 20},
    "resolution": {"spacing": 0.02},
    "numerics": {"scheme": "recommended"},
    "end_time": 0.02
  })");
  const Scene lid = parsed(R"({
    "name": "lid",
    "tank": {"width": 0.2, "height": 0.2, "depth": 0.2, "open_top": false},
    "fluid": [{"shape": "box", "corner": [0, 0, 0], "size": [0.1, 0.2, 0.2]}],
    "gravity": [0, -9.81, 0],
    "resolution": {"spacing": 0.02},
    "numerics": {"scheme": "recommended"},
    "end_time": 0.02
  })");
  for (const Scene& scene : {ball, lid}) {
    Simulation run(scene, {1, ""});
    const std::size_t all = run.solver().particle_count();
    while (!run.finished()) run.step();
    EXPECT_EQ(run.solver().particle_count(), all) << scene.name;
  }
}

TEST(SpaceRun, ReachesTheBoxAndItsEnd) {
  Simulation run(dam_break("mixed"), {2, ""});
  EXPECT_EQ(run.solver().dimensions(), 3);
  EXPECT_EQ(run.solver().particle_count(), 10U * 10U * 12U);
  while (!run.finished()) run.step();
  EXPECT_EQ(run.excluded(), 0U);
  EXPECT_EQ(run.leaked(), 0U);
  for (const Series& series : split(run.samples())) {
    ASSERT_GT(series.size(), 0U) << series.name;
    if (series.name == "arrival") {
      // Ritter's front would need 0.24 m/(2 sqrt(g h)) = 0.086 s; the column has to gather speed.
      EXPECT_GT(series.values.front(), 0.09);
      EXPECT_LT(series.values.front(), 0.25);
    }
    if (series.name == "P") {
      EXPECT_GT(series.weight.back(), 0.0);
    }
    if (series.name == "energy") {
      EXPECT_EQ(series.columns.front().unit, "J");
    }
  }
}

TEST(SpaceRun, OneLayerBetweenTwoWallsKeepsTheSymmetryOfThePlane) {
  // Walls at z = 0 and z = dx hold one layer of particles, which nothing drives across.
  Simulation run(parsed(R"({
    "name": "one-layer",
    "tank": {"width": 0.6, "height": 0.4, "depth": 0.02},
    "fluid": [{"shape": "box", "corner": [0, 0, 0], "size": [0.2, 0.2, 0.02]}],
    "gravity": [0, -9.81, 0],
    "resolution": {"spacing": 0.02},
    "numerics": {"scheme": "recommended", "precision": "double"},
    "end_time": 0.1
  })"),
                 {1, ""});
  while (!run.finished()) run.step();
  const Particles particles = run.checkpoint().solver.particles;
  ASSERT_EQ(particles.size(), 100U);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    EXPECT_NEAR(particles.position[2][i], 0.01, 1e-9);
    EXPECT_NEAR(particles.velocity[2][i], 0.0, 1e-8);
  }
}

/// The scene with its axes x and z exchanged, which is its mirror image too.
TEST(SpaceRun, TurnedByAQuarterIsTheSameToRounding) {
  const auto column = [](const std::string& tank, const std::string& size) {
    return parsed(R"({"name": "column", "tank": {)" + tank + R"(},
      "fluid": [{"shape": "box", "corner": [0, 0, 0], "size": )" +
                  size + R"(}],
      "gravity": [0, -9.81, 0], "resolution": {"spacing": 0.02},
      "numerics": {"scheme": "recommended", "precision": "double"}, "end_time": 0.08})");
  };
  Simulation along(column(R"("width": 0.5, "height": 0.3, "depth": 0.1)", "[0.2, 0.2, 0.1]"), {});
  Simulation across(column(R"("width": 0.1, "height": 0.3, "depth": 0.5)", "[0.1, 0.2, 0.2]"), {});
  while (!along.finished()) along.step();
  while (!across.finished()) across.step();
  EXPECT_EQ(along.solver().step_count(), across.solver().step_count());
  const auto middle = [](const Simulation& run, std::size_t axis) {
    const Particles particles = run.checkpoint().solver.particles;
    double sum = 0.0;
    for (const double x : particles.position[axis]) sum += x;
    return sum / static_cast<double>(particles.size());
  };
  EXPECT_NEAR(middle(along, 0), middle(across, 2), 1e-9);
  EXPECT_NEAR(middle(along, 1), middle(across, 1), 1e-9);
  EXPECT_NEAR(along.solver().energy().kinetic, across.solver().energy().kinetic, 1e-8);
}

TEST(SpaceRun, StillWaterKeepsItsPressure) {
  // The L of two regions, of which one stands on a box: a step in the bed.
  Simulation run(parsed(R"({
    "name": "still",
    "tank": {"width": 0.4, "height": 0.4, "depth": 0.3},
    "fluid": [
      {"shape": "box", "corner": [0, 0, 0], "size": [0.2, 0.24, 0.3]},
      {"shape": "box", "corner": [0.2, 0.1, 0], "size": [0.2, 0.14, 0.3]}
    ],
    "obstacles": [{"shape": "box", "corner": [0.2, 0, 0], "size": [0.2, 0.1, 0.3]}],
    "gravity": [0, -9.81, 0],
    "resolution": {"spacing": 0.02},
    "sensors": [
      {"name": "deep", "kind": "pressure", "position": [0.1, 0, 0.15], "interval": 0},
      {"name": "bed", "kind": "pressure", "position": [0.3, 0.1, 0.15], "interval": 0}
    ],
    "end_time": 0.3
  })"),
                 {2, ""});
  EXPECT_FALSE(run.packing());
  while (!run.finished()) run.step();
  const double weight = 1000.0 * 9.81;
  for (const Series& series : split(run.samples())) {
    const double depth = series.name == "deep" ? 0.24 : 0.14;
    double late = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < series.size(); ++i) {
      if (series.time[i] < 0.15) continue;
      late += series.values[i];
      ++count;
    }
    // The kernel's mean lies some 0.4 h above the floor.
    EXPECT_NEAR(late / static_cast<double>(count), weight * depth, 0.08 * weight * 0.24)
        << series.name;
  }
  EXPECT_LT(run.solver().extremes().max_speed, 0.05);
}

}  // namespace
}  // namespace sluice
