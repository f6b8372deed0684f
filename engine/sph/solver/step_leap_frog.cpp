#include <cmath>

#include "engine/sph/solver/engine_of.hpp"

namespace sluice {

/// eqs. 13-17.
template <typename T>
void Engine<T>::step_leap_frog() {
  if (reinitialisation_due(step_count)) {
    sum_wall_pressure();
    reinitialise();
  }
  sum_wall_pressure();
  const Motion forces = sweep(sweeps_.density_and_acceleration, kRateSums,
                              [&](const ParticleSpan& chunk, const Rates<T>& rates, Motion& seen) {
                                sweeps_.updates.measure_rates(chunk, rates, seen);
                              });
  extremes.max_acceleration = std::sqrt(forces.acceleration_sq);
  const double last = time_step;
  choose_time_step();
  advance_paths(time_step);
  const Motion motion = update_chunks([&](const ParticleSpan& chunk, Motion& seen) {
    const Rates<T> rates = rates_of(chunk, kRateSums);
    for_blocks(chunk, [&](const ParticleSpan& p) {
      sweeps_.updates.leap_frog(p, rates, 0.5 * (last + time_step), time_step);
      sweeps_.updates.measure(p, method, domain, seen);
      write_pairs(p);
      compare_with_paths(p, seen);
    });
  });
  note_motion(motion);
  time += time_step;
  ++step_count;
  walls_.lift(domain.gate, time);
  order_due() ? sort() : keep_lists(motion);
}

template void Engine<float>::step_leap_frog();
template void Engine<double>::step_leap_frog();

}  // namespace sluice
