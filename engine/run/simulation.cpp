#include "engine/run/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "engine/run/build_id.hpp"
#include "engine/run/schedule.hpp"
#include "engine/run/stopwatch.hpp"
#include "engine/scene/filling/initial.hpp"
#include "engine/scene/filling/walls.hpp"
#include "engine/scene/format/canonical.hpp"
#include "engine/scene/geometry/leaks.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/digest.hpp"

namespace sluice {
namespace {

Solver resume_solver(const Scene& scene, const Execution& execution, const SolverState& state) {
  return Solver(scene.method, domain_with_solids(scene), state, scene_walls(scene), execution);
}

void require_same_run(const Checkpoint& checkpoint, const CheckpointIdentity& identity) {
  try {
    require_identity(checkpoint, identity);
  } catch (const StorageError& error) {
    throw StorageError(error.fault(), fmt::format("the checkpoint of step {} is {}",
                                                  checkpoint.solver.step, error.what()));
  }
}

/// Nobody has left; momenta have as many components as the scene has dimensions.
std::array<Departed, kRemovalCauses> nobody_departed(const Scene& scene) {
  std::array<Departed, kRemovalCauses> departed;
  for (Departed& kind : departed) kind.momentum = filled_vec<kAnyDim>(0.0, scene.dimensions());
  return departed;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Simulation::Simulation(Scene scene, const Execution& execution)
    : scene_(std::move(scene)),
      scene_hash_(scene_hash(identity_text(scene_))),
      limits_(GuardLimits::for_method(scene_.method)),
      sensors_(scene_),
      solver_(start_solver(execution)),
      samples_(sensors_.empty_tables()),
      departed_(nobody_departed(scene_)) {
  const Energy energy = solver_.energy();
  count_removed();
  baselines_ = initial_baselines(scene_.method, solver_.state(), energy);
  baselines_.min_density_excess_seen = solver_.extremes().min_density_excess;
  baselines_.max_density_excess_seen = solver_.extremes().max_density_excess;
  if (const auto broken = violation()) throw NumericalFailure(*broken);
  sample();
}

Simulation::Simulation(Scene scene, const Execution& execution, Checkpoint checkpoint)
    : scene_(std::move(scene)),
      scene_hash_(scene_hash(identity_text(scene_))),
      limits_(GuardLimits::for_method(scene_.method)),
      sensors_(scene_),
      solver_(resume_solver(scene_, execution, checkpoint.solver)),
      samples_(std::move(checkpoint.samples)),
      baselines_(checkpoint.guards),
      next_snapshot_(checkpoint.next_snapshot),
      departed_(nobody_departed(scene_)) {
  require_same_run(checkpoint, {scene_hash_, scene_.method.integrator});
  samples_ = in_tables_like(sensors_.empty_tables(), std::move(samples_));
  bit_exact_ = checkpoint.bit_exact && checkpoint.build == build_id() &&
               checkpoint.simd_target == solver_.simd_target();
  count_removed();
}

Solver Simulation::start_solver(const Execution& execution) {
  const CoreStopwatch clock;
  const InitialParticles initial = create_particles(scene_);
  packing_ = initial.packing;
  start_seconds_ = clock.seconds();
  return Solver(scene_.method, domain_with_solids(scene_), initial.state, initial.walls, execution);
}

void Simulation::step() {
  if (failed_) throw std::logic_error("a simulation that failed takes no further step");
  solver_.step();
  particle_steps_ += solver_.particle_count();
  count_removed();
  note_extremes();

  std::optional<Energy> energy;
  const bool periodic = solver_.step_count() % kEnergyInterval == 0;
  if (periodic || finished()) energy = solver_.energy();
  if (periodic) {
    baselines_.highest_energy =
        std::max(baselines_.highest_energy, energy->total() + energy_that_left_);
  }

  const StepFacts now = facts(energy);
  if (auto broken = first_breach(failing_guards(), limits_, now)) {
    failed_ = true;
    throw NumericalFailure(*std::move(broken));
  }
  note_warnings(now);
  sample();
}

std::optional<Diagnosis> Simulation::violation() const {
  return first_breach(failing_guards(), limits_, facts(solver_.energy()));
}

Checkpoint Simulation::checkpoint() const {
  if (failed_) throw std::logic_error("a simulation that failed is not kept in a checkpoint");
  Checkpoint kept;
  kept.scene_hash = scene_hash_;
  kept.build = build_id();
  kept.simd_target = solver_.simd_target();
  kept.bit_exact = bit_exact_;
  kept.integrator = scene_.method.integrator;
  kept.solver = solver_.state();
  kept.samples = samples_;
  kept.guards = baselines_;
  kept.next_snapshot = next_snapshot_;
  return kept;
}

std::optional<std::uint64_t> Simulation::due_snapshot() const {
  if (!scene_.frames || !is_due(solver_.time(), scene_.frames->interval, next_snapshot_)) return {};
  return next_snapshot_;
}

void Simulation::snapshot_written() {
  next_snapshot_ = next_index_after(solver_.time(), scene_.frames->interval, next_snapshot_);
}

std::vector<Diagnosis> Simulation::take_warnings() { return std::exchange(warnings_, {}); }

void Simulation::count_removed() {
  for (; removed_counted_ < solver_.removed_count(); ++removed_counted_) {
    const RemovedParticle one = solver_.removed(removed_counted_);
    departed_[static_cast<std::size_t>(one.cause)].add(scene_.method, one);
    if (is_exclusion(one.cause)) excluded_at_.push_back(one.time);
    energy_that_left_ += energy_that_left(scene_.method, one);
  }
}

void Simulation::note_extremes() {
  const Extremes& now = solver_.extremes();
  GuardBaselines& seen = baselines_;
  seen.max_speed_seen = std::max(seen.max_speed_seen, now.max_speed);
  seen.min_density_excess_seen = std::min(seen.min_density_excess_seen, now.min_density_excess);
  seen.max_density_excess_seen = std::max(seen.max_density_excess_seen, now.max_density_excess);
  seen.max_neighbours_seen =
      std::max(seen.max_neighbours_seen, static_cast<double>(now.max_neighbours));
  const double step = solver_.time_step();
  const bool first = seen.min_time_step_seen == 0.0;
  seen.min_time_step_seen = first ? step : std::min(seen.min_time_step_seen, step);
}

void Simulation::sample() {
  const auto start = std::chrono::steady_clock::now();
  sensors_.sample(solver_, samples_);
  sample_seconds_ += seconds_since(start);
}

void Simulation::note_warnings(const StepFacts& facts) {
  for (const Guard& guard : warning_guards()) {
    if (std::find(warned_.begin(), warned_.end(), guard.reason) != warned_.end()) continue;
    if (auto warning = first_breach({&guard, 1}, limits_, facts)) {
      warned_.emplace_back(guard.reason);
      warnings_.push_back(*std::move(warning));
    }
  }
}

StepFacts Simulation::facts(std::optional<Energy> energy) const {
  StepFacts now;
  now.step = solver_.step_count();
  now.time = solver_.time();
  now.extremes = solver_.extremes();
  for (std::size_t cause = 0; cause < kRemovalCauses; ++cause) {
    now.removed[cause] = departed_[cause].count;
  }
  const double lately = solver_.time() - limits_.crossing_time(baselines_);
  now.excluded_at_once = static_cast<std::size_t>(
      excluded_at_.end() - std::lower_bound(excluded_at_.begin(), excluded_at_.end(), lately));
  now.initial_particles = initial_particles();
  now.particles = solver_.particle_count();
  now.energy = energy;
  now.energy_that_left = energy_that_left_;
  now.baselines = baselines_;
  return now;
}

std::size_t Simulation::initial_particles() const {
  return static_cast<std::size_t>(
      std::llround(baselines_.initial_mass / scene_.method.particle_mass()));
}

}  // namespace sluice
