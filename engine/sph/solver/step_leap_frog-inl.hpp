#pragma once

#include <cmath>

#include "engine/sph/solver/engine_of.hpp"

namespace sluice {

/// eqs. 13-17.
template <typename T, int Dim>
void Engine<T, Dim>::step_leap_frog() {
  if (reinitialisation_due(facts_.step_count)) {
    sum_wall_pressure();
    reinitialise();
  }
  sum_wall_pressure();
  const Motion forces = sweep(sweeps_.density_and_acceleration, kRateSums<Dim>,
                              [&](const Span& chunk, const ChunkRates& rates, Motion& seen) {
                                sweeps_.updates.measure_rates(chunk, rates, seen);
                              });
  facts_.extremes.max_acceleration = std::sqrt(forces.acceleration_sq);
  const double last = facts_.time_step;
  choose_time_step();
  advance_paths(facts_.time_step);
  const Motion motion = update_chunks([&](const Span& chunk, Motion& seen) {
    const ChunkRates rates = rates_of(chunk, kRateSums<Dim>);
    for_blocks(chunk, [&](const Span& p) {
      sweeps_.updates.leap_frog(p, rates, 0.5 * (last + facts_.time_step), facts_.time_step);
      sweeps_.updates.measure(p, method_, domain_, seen);
      write_pairs(p);
      compare_with_paths(p, seen);
    });
  });
  note_motion(motion);
  facts_.time += facts_.time_step;
  ++facts_.step_count;
  walls_.lift(domain_.gate, facts_.time);
  order_due() ? sort() : keep_lists(motion);
}

}  // namespace sluice
