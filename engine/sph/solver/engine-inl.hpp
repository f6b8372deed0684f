#pragma once

#include <cmath>

#include "engine/sph/solver/cluster_bounds-inl.hpp"
#include "engine/sph/solver/dummy_particles-inl.hpp"
#include "engine/sph/solver/engine_of.hpp"
#include "engine/sph/solver/engine_order-inl.hpp"
#include "engine/sph/solver/engine_sums-inl.hpp"
#include "engine/sph/solver/neighbours-inl.hpp"
#include "engine/sph/solver/probes-inl.hpp"
#include "engine/sph/solver/step_kick_drift_kick-inl.hpp"
#include "engine/sph/solver/step_leap_frog-inl.hpp"
#include "engine/sph/solver/term_constants.hpp"

namespace sluice {

inline constexpr double kForceCourant = 0.25;  // of the force limit beside eq. 18

template <typename T, int Dim>
Engine<T, Dim>::Engine(const MethodN<Dim>& method, const FlowDomainN<Dim>& domain,
                       const SolverStateN<Dim>& state, const std::vector<VecN<Dim>>& walls,
                       const Execution& execution)
    : method_(method),
      domain_(domain),
      grid_(domain.box, method.spacing, method.smoothing_length,
            state.particles.size() + walls.size()),
      sweeps_(select_sweeps<T, Dim>(method, execution.simd_target)),
      team_(execution.threads),
      constants_(term_constants<T, Dim>(method, grid_.origin_cell_size())),
      walls_(team_, grid_, method, domain.gate, walls) {
  facts_.wall_count = walls.size();
  facts_.spacing = method.spacing;
  facts_.threads = execution.threads;
  facts_.simd_target = sweeps_.target;

  load(state);
  facts_.pass_seconds = {};  // of steps alone
}

template <typename T, int Dim>
void Engine<T, Dim>::load(const SolverStateN<Dim>& state) {
  facts_.step_count = state.step;
  facts_.time = state.time;
  facts_.time_step = state.time_step;
  facts_.removed = state.removed;
  facts_.particle_count = state.particles.size();

  ParticlesN<Dim> source = state.particles;
  const bool fresh = source.position_sorted.front().empty();
  if (fresh) {
    source.position_sorted = source.position;
    if (method_.integrator == Integrator::modified_leap_frog) {
      source.velocity_half = source.velocity;
      source.density_excess_half = source.density_excess;
    } else {
      for (Values& along : source.acceleration) along.assign(facts_.particle_count, 0.0);
    }
  }
  // Sorting what is in order keeps it, so this also restores the slots of a state that was taken.
  particles_ = std::move(source);
  // Before it spoils what others feel. A state that was taken holds nobody who is to be removed.
  if (fresh) remove();
  reorder(sort_into_clusters<Dim>(team_, grid_, spans_of<Dim>(particles_.position_sorted),
                                  particles_.id));
  walls_.lift(domain_.gate, facts_.time);
  bind();
  // Between sorts nobody counts: a state that is gone on with must not be judged otherwise.
  if (fresh) count_neighbours();
  if (method_.integrator == Integrator::kick_drift_kick) {
    sum_wall_pressure();
    if (fresh) start_kick_drift_kick();
  }
  measure();
}

template <typename T, int Dim>
ParticleSpan<Dim> Engine<T, Dim>::span(std::size_t chunk) {
  ParticlesN<Dim>& p = particles_;
  const auto data = [](Values& field) { return field.empty() ? nullptr : field.data(); };
  const auto axes = [&](std::array<Values, Dim>& field) {
    std::array<double*, Dim> pointers;
    for (std::size_t axis = 0; axis < Dim; ++axis) pointers[axis] = data(field[axis]);
    return pointers;
  };
  return {.begin = kCluster * layout_.chunk_begin(chunk),
          .end = kCluster * layout_.chunk_begin(chunk + 1),
          .position = axes(p.position),
          .velocity = axes(p.velocity),
          .density_excess = data(p.density_excess),
          .velocity_half = axes(p.velocity_half),
          .density_excess_half = data(p.density_excess_half),
          .acceleration = axes(p.acceleration),
          .id = data(p.id)};
}

template <typename T, int Dim>
void Engine<T, Dim>::note_motion(const Motion& seen) {
  facts_.extremes.max_speed = std::sqrt(seen.speed_sq);
  facts_.extremes.min_density_excess = facts_.particle_count > 0 ? seen.min_density_excess : 0.0;
  facts_.extremes.max_density_excess = facts_.particle_count > 0 ? seen.max_density_excess : 0.0;
  if (method_.integrator == Integrator::kick_drift_kick) {
    facts_.extremes.max_acceleration = std::sqrt(seen.acceleration_sq);
  }
  facts_.extremes.max_x = seen.max_x;
  leaving_ = seen.leaving;
}

template <typename T, int Dim>
void Engine<T, Dim>::measure() {
  note_motion(for_chunks([&](const Span& p, Motion& seen) {
    sweeps_.updates.measure(p, method_, domain_, seen);
    if (p.acceleration[0] != nullptr) sweeps_.updates.measure_acceleration(p, seen);
  }));
}

/// eq. 18 with its unit mended, and the force limit: dt <= C h/(c + |v|), dt <= 0.25 sqrt(h/|a|),
/// but for the least step.
template <typename T, int Dim>
void Engine<T, Dim>::choose_time_step() {
  const double h = method_.smoothing_length;
  const double sound = method_.courant * h / (method_.sound_speed + facts_.extremes.max_speed);
  const double force = kForceCourant * std::sqrt(h / facts_.extremes.max_acceleration);
  facts_.step_limit = force < sound ? StepLimit::force : StepLimit::sound;
  facts_.time_step = std::max(method_.least_time_step(), std::min(force, sound));
}

template <typename T, int Dim>
void Engine<T, Dim>::step() {
  if (method_.integrator == Integrator::modified_leap_frog) {
    step_leap_frog();
  } else {
    step_kick_drift_kick();
  }
}

// For readers.

template <typename T, int Dim>
SolverStateN<Dim> Engine<T, Dim>::state() const {
  SolverStateN<Dim> out;
  out.step = facts_.step_count;
  out.time = facts_.time;
  out.time_step = facts_.time_step;
  out.removed = facts_.removed;
  for (const FieldN<Dim>& field : FieldList<Dim>::fields) {
    if (!carries(method_.integrator, field)) continue;
    const Values& from = field.values.of(particles_);
    Values& to = field.values.of(out.particles);
    to.reserve(facts_.particle_count);
    for (std::size_t s = 0; s < from.size(); ++s) {
      if (particles_.id[s] >= 0.0) to.push_back(from[s]);
    }
  }
  return out;
}

template <typename T, int Dim>
Energy Engine<T, Dim>::energy() {
  return for_chunks<Energy>(
      [&](const Span& p, Energy& sum) { sweeps_.updates.sum_energy(p, method_, sum); });
}

template <typename T, int Dim>
FluidProbe<Dim> Engine<T, Dim>::probe() const {
  return {method_, domain_, particles_, layout_, bounds_, sweeps_.updates.sum_around};
}

template <typename T, int Dim>
std::vector<double> Engine<T, Dim>::wall_pressures() const {
  return walls_.pressures(method_);
}

template <typename T, int Dim>
double Engine<T, Dim>::pair_slots() const {
  std::size_t entries = 0;
  for (const PairList::Chunk& chunk : fluid_to_fluid_.chunks) entries += chunk.entries.size();
  const auto pairs = static_cast<double>(kCluster * kCluster * entries);
  return pairs / static_cast<double>(std::max<std::size_t>(facts_.particle_count, 1));
}

template <typename T, int Dim>
std::size_t Engine<T, Dim>::memory_bytes() const {
  std::size_t bytes = pairs_.bytes() + walls_.bytes() + paths_.bytes() + sums_.bytes() +
                      fluid_to_fluid_.bytes() + fluid_to_wall_.bytes() + wall_to_fluid_.bytes();
  for (const FieldN<Dim>& field : FieldList<Dim>::fields)
    bytes += field.values.of(particles_).capacity() * sizeof(double);
  return bytes + bounds_.bytes();
}

template <typename T, int Dim>
std::unique_ptr<typename SolverN<Dim>::Impl> make_engine(const MethodN<Dim>& method,
                                                         const FlowDomainN<Dim>& domain,
                                                         const SolverStateN<Dim>& state,
                                                         const std::vector<VecN<Dim>>& walls,
                                                         const Execution& execution) {
  return std::make_unique<Engine<T, Dim>>(method, domain, state, walls, execution);
}

}  // namespace sluice
