#include "engine/run/sampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/run/simulation.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/digest.hpp"
#include "tests/run/scenes.hpp"

namespace sluice {
namespace {

using testing::small_dam_break;

constexpr double kAir = -300.0;

/// A solver with these particles, all of one pressure, and the scene's walls left out: sampling
/// looks at the fluid and at the scene's shape.
Solver fluid_at(const Scene& scene, const std::vector<Vec2>& places, double pressure) {
  SolverState state;
  const double c = scene.method.sound_speed;
  for (const Vec2& place : places) {
    Particles& p = state.particles;
    p.id.push_back(static_cast<double>(p.size()));
    append(p.position, place);
    append(p.velocity, Vec2(Vec2::Zero()));
    p.density_excess.push_back(pressure / (c * c));
  }
  return {scene.method, scene.domain, state, {}, {}};
}

/// Particles in columns from the right wall of the tank to the left, all its height.
std::vector<Vec2> columns_at_wall(const Scene& scene, int columns) {
  const double dx = scene.method.spacing;
  std::vector<Vec2> places;
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; (row + 0.5) * dx < scene.tank->height; ++row) {
      places.emplace_back(scene.tank->width - (column + 0.5) * dx, (row + 0.5) * dx);
    }
  }
  return places;
}

Sensor at_wall(const Scene& scene, std::optional<double> air) {
  Sensor sensor;
  sensor.name = "P";
  sensor.position = Vec2(scene.tank->width, 0.15);
  sensor.air_pressure = air;
  return sensor;
}

struct Sample {
  double value;
  double weight;
};

Sample sample(const Scene& scene, const Sensor& sensor, const Solver& solver) {
  std::vector<double> values(1);
  const double weight = make_sampler(sensor, scene)->sample(solver, values);
  return {values[0], weight};
}

TEST(PressureSampler, CoveredByFluidItsFaceFeelsTheFluidAlone) {
  const Scene scene = small_dam_break();
  const Solver solver = fluid_at(scene, columns_at_wall(scene, 12), 1000.0);
  const Sample face = sample(scene, at_wall(scene, kAir), solver);
  const Sample plain = sample(scene, at_wall(scene, std::nullopt), solver);
  EXPECT_NEAR(plain.value, 1000.0, 1e-9);
  // On a lattice of h = dx the weight is a half to 1e-3; what lacks is taken for air.
  EXPECT_NEAR(face.value, 1000.0, 1e-2 * (1000.0 - kAir));
  EXPECT_EQ(face.weight, plain.weight);
}

TEST(PressureSampler, AThinJetPressesOnTheFaceByItsShareOnly) {
  const Scene scene = small_dam_break();
  for (const int columns : {1, 2}) {
    const Solver solver = fluid_at(scene, columns_at_wall(scene, columns), 1000.0);
    const Sample plain = sample(scene, at_wall(scene, std::nullopt), solver);
    const Sample face = sample(scene, at_wall(scene, kAir), solver);
    EXPECT_NEAR(plain.value, 1000.0, 1e-9) << "eq. 11 takes the jet's pressure for all";
    ASSERT_LT(plain.weight, 0.5);
    EXPECT_NEAR(face.value, kAir + (1000.0 - kAir) * plain.weight / 0.5, 1e-9);
    EXPECT_EQ(face.weight, plain.weight);
  }
}

TEST(PressureSampler, TheFaceHasNoJumpWhereASingleParticleComes) {
  const Scene scene = small_dam_break();
  const double support = scene.method.support();
  double last = kAir;
  for (double gap = 1.001 * support; gap > 0.0; gap -= support / 100) {
    const Solver solver = fluid_at(scene, {{scene.tank->width - gap, 0.15}}, 1000.0);
    const Sample face = sample(scene, at_wall(scene, kAir), solver);
    EXPECT_GE(face.value, last);
    EXPECT_LT(face.value - last, 0.05 * (1000.0 - kAir)) << "at " << gap;
    last = face.value;
  }
  const Solver near = fluid_at(scene, {{scene.tank->width - 0.999 * support, 0.15}}, 1000.0);
  EXPECT_NEAR(sample(scene, at_wall(scene, std::nullopt), near).value, 1000.0, 1e-9)
      << "eq. 11 jumps";
}

TEST(PressureSampler, WithoutFluidTheFaceFeelsTheAirWithoutWeight) {
  const Scene scene = small_dam_break();
  const Solver solver = fluid_at(scene, {{0.1, 0.1}}, 1000.0);
  const Sample face = sample(scene, at_wall(scene, kAir), solver);
  EXPECT_EQ(face.value, kAir);
  EXPECT_EQ(face.weight, 0.0);
  const Sample plain = sample(scene, at_wall(scene, std::nullopt), solver);
  EXPECT_TRUE(std::isnan(plain.value));
  EXPECT_EQ(plain.weight, 0.0);
}

Sensor sensor_at(const std::string& name, SensorKind kind, const Vec2& position, double interval) {
  Sensor sensor;
  sensor.name = name;
  sensor.kind = kind;
  sensor.position = position;
  sensor.interval = interval;
  return sensor;
}

TEST(SensorArray, KeepsSensorsOfOneKindAndIntervalInOneTable) {
  Scene scene = small_dam_break();
  const Vec2 low(0.05, 0.01);
  const Vec2 high(0.05, 0.10);
  scene.sensors = {sensor_at("low", SensorKind::pressure, low, 0.001),
                   sensor_at("energy", SensorKind::energy, low, 0.001),
                   sensor_at("often", SensorKind::pressure, low, 0.0),
                   sensor_at("height", SensorKind::surface_height, low, 0.001),
                   sensor_at("high", SensorKind::pressure, high, 0.001),
                   sensor_at("first", SensorKind::arrival, low, 0.001),
                   sensor_at("second", SensorKind::arrival, high, 0.001),
                   sensor_at("energy again", SensorKind::energy, low, 0.001)};
  const SensorArray array(scene);
  std::vector<std::vector<std::string>> names;
  for (const SampleTable& table : array.empty_tables()) names.push_back(table.names);
  const std::vector<std::vector<std::string>> expected{
      {"low", "high"}, {"energy", "energy again"}, {"often"}, {"height"}, {"first"}, {"second"}};
  EXPECT_EQ(names, expected);

  std::vector<SampleTable> tables = array.empty_tables();
  const Solver solver = fluid_at(scene, columns_at_wall(scene, 12), 1000.0);
  array.sample(solver, tables);
  const std::vector<Series> series = split(tables);
  ASSERT_EQ(series.size(), scene.sensors.size());
  for (std::size_t i = 0; i < series.size(); ++i) EXPECT_EQ(series[i].name, scene.sensors[i].name);
  EXPECT_EQ(series[5].size(), 0U) << "no fluid has arrived";
}

TEST(SensorArray, SamplesManySensorsToTheSameBitsWithAnyNumberOfThreads) {
  Scene scene = small_dam_break();
  scene.sensors.clear();
  for (int i = 0; i < 100; ++i) {
    const Vec2 place(0.0015 * i, 0.0016 * i);
    const SensorKind kind = i % 3 == 0 ? SensorKind::surface_height : SensorKind::pressure;
    scene.sensors.push_back(sensor_at("s" + std::to_string(i), kind, place, 0.0));
  }
  const Vec2 wet(0.003, 0.003);
  scene.sensors.push_back(sensor_at("energy", SensorKind::energy, wet, 0.0));
  scene.sensors.push_back(sensor_at("wet at once", SensorKind::arrival, wet, 0.0));
  scene.sensors.push_back(sensor_at("energy again", SensorKind::energy, wet, 0.0));
  scene.sensors.push_back(sensor_at("never wet", SensorKind::arrival, Vec2(10.0, 10.0), 0.0));
  const auto run = [&](int threads) {
    Simulation simulation(scene, {threads, ""});
    while (simulation.solver().step_count() < 40) simulation.step();
    return simulation;
  };
  const Simulation one = run(1);
  const std::vector<Series> series = split(one.samples());
  const std::string digest = physics_digest(one.checkpoint());
  for (const int threads : {2, 3, 8}) {
    EXPECT_EQ(physics_digest(run(threads).checkpoint()), digest) << threads;
  }
  Simulation interrupted(scene, {2, ""});
  while (interrupted.solver().step_count() < 17) interrupted.step();
  Simulation resumed(scene, {3, ""},
                     decode_checkpoint(encode_checkpoint(interrupted.checkpoint())));
  while (resumed.solver().step_count() < 40) resumed.step();
  EXPECT_EQ(physics_digest(resumed.checkpoint()), digest);
  // As earlier builds left it: each sensor by itself.
  Checkpoint by_sensor = interrupted.checkpoint();
  const std::vector<Series> so_far = split(by_sensor.samples);
  by_sensor.samples.clear();
  for (std::size_t i = 0; i < so_far.size(); ++i) {
    by_sensor.samples.push_back(table_of(so_far[i]));
    by_sensor.samples.back().places = {i};
  }
  Checkpoint swapped = by_sensor;
  std::swap(swapped.samples[1].names, swapped.samples[2].names);
  EXPECT_THROW(Simulation(scene, {1, ""}, swapped), StorageError);
  Simulation gone_on(scene, {1, ""}, by_sensor);
  while (gone_on.solver().step_count() < 40) gone_on.step();
  EXPECT_EQ(physics_digest(gone_on.checkpoint()), digest);

  EXPECT_EQ(series[100].values.size(), 3U * 41U);
  EXPECT_EQ(series[102].values, series[100].values);
  EXPECT_EQ(series[101].size(), 1U);
  EXPECT_EQ(series[103].size(), 0U);
  for (std::size_t i = 0; i < 100; ++i) {
    const Sample alone = sample(scene, scene.sensors[i], one.solver());
    ASSERT_EQ(series[i].size(), 41U);
    EXPECT_EQ(series[i].weight.back(), alone.weight) << i;
    if (alone.weight > 0.0) {
      EXPECT_EQ(series[i].values.back(), alone.value) << i;
    }
  }
}

}  // namespace
}  // namespace sluice
