#pragma once

#include "engine/sph/solver/engine_of.hpp"
#include "engine/sph/solver/term_constants.hpp"

namespace sluice {

inline constexpr double kMostShift = 0.1;  // dx at a time

template <typename T, int Dim>
bool Engine<T, Dim>::shifting_due() const {
  return method_.shifting && facts_.step_count % ParticleShifting::kInterval == 0;
}

template <typename T, int Dim>
Shift<Dim> Engine<T, Dim>::shift_of_step() const {
  const double scale = scale_of_sums(method_);
  const double duration = static_cast<double>(ParticleShifting::kInterval) * facts_.time_step;
  return {
      method_.shifting->coefficient * duration * scale, scale, kMostShift * method_.spacing,
      method_.reference_density / (method_.sound_speed * method_.sound_speed) * method_.gravity};
}

/// The acceleration that the first half kick needs.
template <typename T, int Dim>
void Engine<T, Dim>::start_kick_drift_kick() {
  sweep(sweeps_.acceleration, kAccelerationSums<Dim>,
        [&](const Span& p, const ChunkRates& rates, Motion&) {
          sweeps_.updates.kick(p, rates, 0.0);
        });
}

/// Adami et al. 2012: half kick, half drift, density, half drift, wall pressure, acceleration, half
/// kick.
template <typename T, int Dim>
void Engine<T, Dim>::step_kick_drift_kick() {
  choose_time_step();
  advance_paths(0.5 * facts_.time_step);
  keep_lists(update_chunks([&](const Span& chunk, Motion& seen) {
    for_blocks(chunk, [&](const Span& p) {
      sweeps_.updates.kick_drift(p, facts_.time_step);
      sweeps_.updates.write_places(p, scales_, pairs_);
      sweeps_.updates.write_velocities(p, scales_, pairs_);
      compare_with_paths(p, seen);
    });
  }));
  const bool shifting = shifting_due();
  const Shift<Dim> shift = shifting ? shift_of_step() : Shift<Dim>{};
  advance_paths(0.5 * facts_.time_step);
  keep_lists(sweep(shifting ? sweeps_.density_and_shift : sweeps_.density,
                   shifting ? kDensityAndShiftingSums<Dim> : kDensitySums<Dim>,
                   [&](const Span& chunk, const ChunkRates& rates, Motion& seen) {
                     for_blocks(chunk, [&](const Span& p) {
                       sweeps_.updates.density_drift(p, rates, facts_.time_step);
                       if (shifting) sweeps_.updates.shift(p, rates, shift);
                       sweeps_.updates.write_places(p, scales_, pairs_);
                       sweeps_.updates.write_densities(p, scales_, pairs_);
                       compare_with_paths(p, seen);
                     });
                   }));
  sum_wall_pressure();
  if (reinitialisation_due(facts_.step_count + 1)) {
    reinitialise();
    sum_wall_pressure();
  }
  note_motion(sweep(sweeps_.acceleration, kAccelerationSums<Dim>,
                    [&](const Span& chunk, const ChunkRates& rates, Motion& seen) {
                      for_blocks(chunk, [&](const Span& p) {
                        sweeps_.updates.kick(p, rates, facts_.time_step);
                        sweeps_.updates.measure(p, method_, domain_, seen);
                        sweeps_.updates.measure_acceleration(p, seen);
                      });
                    }));
  facts_.time += facts_.time_step;
  ++facts_.step_count;
  walls_.lift(domain_.gate, facts_.time);
  if (order_due()) sort();
}

}  // namespace sluice
