#include "engine/sph/solver/engine.hpp"

#include <cmath>

#include "engine/sph/solver/engine_of.hpp"
#include "engine/sph/solver/term_constants.hpp"

namespace sluice {
namespace {

constexpr double kForceCourant = 0.25;  // of the force limit beside eq. 18

}  // namespace

template <typename T>
Engine<T>::Engine(const Method& m, const FlowDomain& where, const SolverState& state,
                  const std::vector<Vec>& walls, const Execution& exec)
    : grid_(where.box, m.spacing, m.smoothing_length, state.particles.size() + walls.size()),
      sweeps_(select_sweeps<T>(m, exec.simd_target)),
      team_(exec.threads),
      constants_(term_constants<T>(m, grid_.origin_cell_size())),
      walls_(team_, grid_, m, where.gate, walls) {
  method = m;
  domain = where;
  execution = exec;
  wall_count = walls.size();
  simd_target = sweeps_.target;

  load(state);
  pass_seconds = {};  // of steps alone
}

template <typename T>
void Engine<T>::load(const SolverState& state) {
  step_count = state.step;
  time = state.time;
  time_step = state.time_step;
  removed = state.removed;
  particle_count = state.particles.size();

  Particles source = state.particles;
  const bool fresh = source.position_sorted.front().empty();
  if (fresh) {
    source.position_sorted = source.position;
    if (method.integrator == Integrator::modified_leap_frog) {
      source.velocity_half = source.velocity;
      source.density_excess_half = source.density_excess;
    } else {
      for (Values& along : source.acceleration) along.assign(particle_count, 0.0);
    }
  }
  // Sorting what is in order keeps it, so this also restores the slots of a state that was taken.
  particles = std::move(source);
  // Before it spoils what others feel. A state that was taken holds nobody who is to be removed.
  if (fresh) remove();
  reorder(sort_into_clusters(team_, grid_, particles.position_sorted[0],
                             particles.position_sorted[1], particles.id));
  walls_.lift(domain.gate, time);
  bind();
  // Between sorts nobody counts: a state that is gone on with must not be judged otherwise.
  if (fresh) count_neighbours();
  if (method.integrator == Integrator::kick_drift_kick) {
    sum_wall_pressure();
    if (fresh) start_kick_drift_kick();
  }
  measure();
}

template <typename T>
ParticleSpan Engine<T>::span(std::size_t chunk) {
  Particles& p = particles;
  const auto data = [](std::vector<double>& field) {
    return field.empty() ? nullptr : field.data();
  };
  return {.begin = kCluster * layout.chunk_begin(chunk),
          .end = kCluster * layout.chunk_begin(chunk + 1),
          .x = data(p.position[0]),
          .y = data(p.position[1]),
          .vx = data(p.velocity[0]),
          .vy = data(p.velocity[1]),
          .density_excess = data(p.density_excess),
          .vx_half = data(p.velocity_half[0]),
          .vy_half = data(p.velocity_half[1]),
          .density_excess_half = data(p.density_excess_half),
          .ax = data(p.acceleration[0]),
          .ay = data(p.acceleration[1]),
          .id = data(p.id)};
}

template <typename T>
void Engine<T>::note_motion(const Motion& seen) {
  extremes.max_speed = std::sqrt(seen.speed_sq);
  extremes.min_density_excess = particle_count > 0 ? seen.min_density_excess : 0.0;
  extremes.max_density_excess = particle_count > 0 ? seen.max_density_excess : 0.0;
  if (method.integrator == Integrator::kick_drift_kick) {
    extremes.max_acceleration = std::sqrt(seen.acceleration_sq);
  }
  extremes.max_x = seen.max_x;
  leaving_ = seen.leaving;
}

template <typename T>
void Engine<T>::measure() {
  note_motion(for_chunks([&](const ParticleSpan& p, Motion& seen) {
    sweeps_.updates.measure(p, method, domain, seen);
    if (p.ax != nullptr) sweeps_.updates.measure_acceleration(p, seen);
  }));
}

/// eq. 18 with its unit mended, and the force limit: dt <= C h/(c + |v|), dt <= 0.25 sqrt(h/|a|),
/// but for the least step.
template <typename T>
void Engine<T>::choose_time_step() {
  const double h = method.smoothing_length;
  const double sound = method.courant * h / (method.sound_speed + extremes.max_speed);
  const double force = kForceCourant * std::sqrt(h / extremes.max_acceleration);
  step_limit = force < sound ? StepLimit::force : StepLimit::sound;
  time_step = std::max(method.least_time_step(), std::min(force, sound));
}

template <typename T>
void Engine<T>::step() {
  if (method.integrator == Integrator::modified_leap_frog) {
    step_leap_frog();
  } else {
    step_kick_drift_kick();
  }
}

// For readers.

template <typename T>
Energy Engine<T>::energy() {
  return for_chunks<Energy>(
      [&](const ParticleSpan& p, Energy& sum) { sweeps_.updates.sum_energy(p, method, sum); });
}

template <typename T>
FluidProbe Engine<T>::probe() const {
  return {method, domain, particles, layout, bounds, sweeps_.updates.sum_around};
}

template <typename T>
std::vector<double> Engine<T>::wall_pressures() const {
  return walls_.pressures(method);
}

template <typename T>
double Engine<T>::pair_slots() const {
  std::size_t entries = 0;
  for (const PairList::Chunk& chunk : fluid_to_fluid_.chunks) entries += chunk.entries.size();
  const auto pairs = static_cast<double>(kCluster * kCluster * entries);
  return pairs / static_cast<double>(std::max<std::size_t>(particle_count, 1));
}

template <typename T>
std::size_t Engine<T>::memory_bytes() const {
  std::size_t bytes = pairs_.bytes() + walls_.bytes() + paths_.bytes() + sums_.bytes() +
                      fluid_to_fluid_.bytes() + fluid_to_wall_.bytes() + wall_to_fluid_.bytes();
  for (const Field& field : kFields)
    bytes += field.values.of(particles).capacity() * sizeof(double);
  return bytes + bounds.bytes();
}

template void Engine<float>::note_motion(const Motion&);
template void Engine<double>::note_motion(const Motion&);
template void Engine<float>::measure();
template void Engine<double>::measure();
template void Engine<float>::choose_time_step();
template void Engine<double>::choose_time_step();
template ParticleSpan Engine<float>::span(std::size_t);
template ParticleSpan Engine<double>::span(std::size_t);

template <typename T>
std::unique_ptr<Solver::Impl> make_engine(const Method& method, const FlowDomain& domain,
                                          const SolverState& state, const std::vector<Vec>& walls,
                                          const Execution& execution) {
  return std::make_unique<Engine<T>>(method, domain, state, walls, execution);
}

template std::unique_ptr<Solver::Impl> make_engine<float>(const Method&, const FlowDomain&,
                                                          const SolverState&,
                                                          const std::vector<Vec>&,
                                                          const Execution&);
template std::unique_ptr<Solver::Impl> make_engine<double>(const Method&, const FlowDomain&,
                                                           const SolverState&,
                                                           const std::vector<Vec>&,
                                                           const Execution&);

}  // namespace sluice
