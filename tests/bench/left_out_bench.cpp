/// What a scene saves by leaving something out: steps of the paper's dam break (20 000 particles,
/// one thread) with all of its terms, and with one of them at a time not there. Compare the time
/// per step of two lines, taken in turns:
///   bench_left_out --benchmark_enable_random_interleaving=true --benchmark_repetitions=9
///   --benchmark_report_aggregates_only=true
#include <benchmark/benchmark.h>

#include <stdexcept>

#include "engine/run/simulation.hpp"
#include "engine/scene/checks/parse.hpp"

namespace sluice {
namespace {

constexpr const char* kPaper = R"json({
  "name": "paper",
  "tank": {"width": 1.61, "height": 0.6},
  "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.6, 0.3]}],
  "gravity": [0, -9.81],
  "material": {"density": 1000, "sound_speed": 24.26},
  "resolution": {"spacing": 0.003},
  "numerics": {
    "scheme": "paper",
    "integrator": "modified_leap_frog",
    "courant": 0.25,
    "density_diffusion": {"delta": 0.1},
    "artificial_viscosity": {"alpha": 0.02},
    "reinitialisation": {"interval": 20}
  },
  "sensors": [
    {"name": "P1", "kind": "pressure", "position": [1.61, 0.003], "interval": 5e-05},
    {"name": "P2", "kind": "pressure", "position": [1.61, 0.015], "interval": 5e-05},
    {"name": "P3", "kind": "pressure", "position": [1.61, 0.03], "interval": 5e-05},
    {"name": "P4", "kind": "pressure", "position": [1.61, 0.08], "interval": 5e-05},
    {"name": "energy", "kind": "energy", "interval": 0.001}
  ],
  "end_time": 200
})json";

Scene paper() {
  const ParseResult parsed = parse_scene(kPaper);
  if (!parsed.scene) throw std::logic_error(parsed.problems.front().message);
  return *parsed.scene;
}

void steps(benchmark::State& state, const Scene& scene) {
  Simulation simulation(scene, Execution{});
  for (int warm_up = 0; warm_up < 100; ++warm_up) simulation.step();
  const std::uint64_t before = simulation.particle_steps();
  for ([[maybe_unused]] const auto& step : state) simulation.step();
  state.SetItemsProcessed(static_cast<std::int64_t>(simulation.particle_steps() - before));
}

using Change = void (*)(Scene&);

struct Case {
  const char* name;
  Change change;
};

constexpr Case kCases[] = {
    {"everything", [](Scene&) {}},
    {"no_diffusion", [](Scene& scene) { scene.method.diffusion.reset(); }},
    {"no_viscosity", [](Scene& scene) { scene.method.viscosity.reset(); }},
    {"no_reinitialisation", [](Scene& scene) { scene.method.reinitialisation.reset(); }},
    {"no_sensors", [](Scene& scene) { scene.sensors.clear(); }},
    {"no_gravity", [](Scene& scene) { scene.method.gravity = Vec2::Zero(); }},
    {"no_walls",
     [](Scene& scene) {
       scene.tank.reset();
       scene.domain.wall_top.reset();
     }},
    {"nothing_but_the_fluid",
     [](Scene& scene) {
       scene.tank.reset();
       scene.domain.wall_top.reset();
       scene.sensors.clear();
       scene.method.diffusion.reset();
       scene.method.viscosity.reset();
       scene.method.reinitialisation.reset();
     }},
    {"with_wall_artificial_viscosity",
     [](Scene& scene) { scene.method.wall_artificial_viscosity.emplace(); }},
    {"in_double_precision",
     [](Scene& scene) { scene.method.precision = Precision::double_precision; }},
};

}  // namespace
}  // namespace sluice

int main(int argc, char** argv) {
  for (const sluice::Case& one : sluice::kCases) {
    sluice::Scene scene = sluice::paper();
    one.change(scene);
    benchmark::RegisterBenchmark(one.name,
                                 [scene](benchmark::State& state) { sluice::steps(state, scene); })
        ->Iterations(300)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
