#include "engine/scene/forecast/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/scene/filling/initial.hpp"
#include "engine/scene/filling/walls.hpp"
#include "engine/scene/forecast/workload.hpp"
#include "engine/scene/format/written_scene.hpp"
#include "engine/scene/geometry/geometry.hpp"
#include "engine/sph/method/particles.hpp"
#include "engine/sph/solver/machine_speed.hpp"

namespace sluice {
namespace {

// The most memory at once, bytes (tests/bench/memory.py): what a run takes without particles;
// state, pair arrays, sums and lists of one particle with its copy and image while a checkpoint is
// written.
constexpr std::uint64_t kProgramBytes = 28'000'000;
constexpr std::uint64_t kFluidBytesMixed = 390;
constexpr std::uint64_t kFluidBytesDouble = 470;
constexpr std::uint64_t kWallBytes = 100;
// time, duration, value and weight of one sample, bytes; the same three times while they are
// written.
constexpr std::uint64_t kSampleBytes = 32;
constexpr std::uint64_t kSampleCopies = 3;
// Position, velocity, pressure and id of one particle in a snapshot, bytes.
constexpr std::uint64_t kFrameBytes = 28;
constexpr std::uint64_t kCheckpoints = 3;

std::uint64_t checkpoint_bytes_per_particle(const Method& method) {
  std::uint64_t fields = 0;
  for (const Field& field : fields_in(static_cast<std::size_t>(method.dimensions()))) {
    if (field.role == Role::state && carries(method.integrator, field)) ++fields;
  }
  return fields * sizeof(double);
}

std::uint64_t whole(double value) { return static_cast<std::uint64_t>(std::ceil(value)); }

Estimate complete(const Scene& scene, std::uint64_t fluid, std::uint64_t walls) {
  Estimate e;
  e.fluid_particles = fluid;
  e.wall_particles = walls;
  e.time_step = expected_time_step(scene);
  e.steps = whole(scene.end_time / e.time_step);
  e.samples = whole(count_samples(scene));
  e.frames = whole(count_frames(scene));
  const bool mixed = scene.method.precision == Precision::mixed;
  e.memory_bytes = kProgramBytes +
                   e.fluid_particles * (mixed ? kFluidBytesMixed : kFluidBytesDouble) +
                   e.wall_particles * kWallBytes + e.samples * kSampleBytes * kSampleCopies;
  e.disk_bytes = kCheckpoints * (e.fluid_particles * checkpoint_bytes_per_particle(scene.method) +
                                 e.samples * kSampleBytes) +
                 e.samples * kSampleBytes + e.frames * e.fluid_particles * kFrameBytes;
  return e;
}

}  // namespace

Estimate estimate(const Scene& scene) {
  return complete(scene, whole(count_fluid_cells(scene)), whole(count_wall_cells(scene)));
}

Estimate exact_estimate(const Scene& scene) {
  return complete(scene, start_plan(scene).fluid_particles, scene_walls(scene).size());
}

double expected_core_seconds(const Scene& scene, const Estimate& estimate, std::string_view simd) {
  return static_cast<double>(estimate.fluid_particles) * static_cast<double>(estimate.steps) /
         particle_steps_per_core_second(scene.method, simd);
}

std::string estimate_json(const Estimate& e) {
  return nlohmann::ordered_json{{"fluid_particles", e.fluid_particles},
                                {"wall_particles", e.wall_particles},
                                {"time_step", e.time_step},
                                {"steps", e.steps},
                                {"samples", e.samples},
                                {"frames", e.frames},
                                {"memory_bytes", e.memory_bytes},
                                {"disk_bytes", e.disk_bytes}}
      .dump();
}

}  // namespace sluice
