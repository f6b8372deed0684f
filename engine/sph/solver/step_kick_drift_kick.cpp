#include "engine/sph/solver/engine_of.hpp"
#include "engine/sph/solver/term_constants.hpp"

namespace sluice {
namespace {

constexpr double kMostShift = 0.1;  // dx at a time

}  // namespace

template <typename T>
bool Engine<T>::shifting_due() const {
  return method.shifting && step_count % ParticleShifting::kInterval == 0;
}

template <typename T>
Shift Engine<T>::shift_of_step() const {
  const double scale = scale_of_sums(method);
  const double duration = static_cast<double>(ParticleShifting::kInterval) * time_step;
  return {method.shifting->coefficient * duration * scale, scale, kMostShift * method.spacing,
          method.reference_density / (method.sound_speed * method.sound_speed) * method.gravity};
}

/// The acceleration that the first half kick needs.
template <typename T>
void Engine<T>::start_kick_drift_kick() {
  sweep(sweeps_.acceleration, kAccelerationSums,
        [&](const ParticleSpan& p, const Rates<T>& rates, Motion&) {
          sweeps_.updates.kick(p, rates, 0.0);
        });
}

/// Adami et al. 2012: half kick, half drift, density, half drift, wall pressure, acceleration, half
/// kick.
template <typename T>
void Engine<T>::step_kick_drift_kick() {
  choose_time_step();
  advance_paths(0.5 * time_step);
  keep_lists(update_chunks([&](const ParticleSpan& chunk, Motion& seen) {
    for_blocks(chunk, [&](const ParticleSpan& p) {
      sweeps_.updates.kick_drift(p, time_step);
      sweeps_.updates.write_places(p, scales_, pairs_);
      sweeps_.updates.write_velocities(p, scales_, pairs_);
      compare_with_paths(p, seen);
    });
  }));
  const bool shifting = shifting_due();
  const Shift shift = shifting ? shift_of_step() : Shift{};
  advance_paths(0.5 * time_step);
  keep_lists(sweep(shifting ? sweeps_.density_and_shift : sweeps_.density,
                   shifting ? kDensityAndShiftingSums : kDensitySums,
                   [&](const ParticleSpan& chunk, const Rates<T>& rates, Motion& seen) {
                     for_blocks(chunk, [&](const ParticleSpan& p) {
                       sweeps_.updates.density_drift(p, rates, time_step);
                       if (shifting) sweeps_.updates.shift(p, rates, shift);
                       sweeps_.updates.write_places(p, scales_, pairs_);
                       sweeps_.updates.write_densities(p, scales_, pairs_);
                       compare_with_paths(p, seen);
                     });
                   }));
  sum_wall_pressure();
  if (reinitialisation_due(step_count + 1)) {
    reinitialise();
    sum_wall_pressure();
  }
  note_motion(sweep(sweeps_.acceleration, kAccelerationSums,
                    [&](const ParticleSpan& chunk, const Rates<T>& rates, Motion& seen) {
                      for_blocks(chunk, [&](const ParticleSpan& p) {
                        sweeps_.updates.kick(p, rates, time_step);
                        sweeps_.updates.measure(p, method, domain, seen);
                        sweeps_.updates.measure_acceleration(p, seen);
                      });
                    }));
  time += time_step;
  ++step_count;
  walls_.lift(domain.gate, time);
  if (order_due()) sort();
}

template void Engine<float>::start_kick_drift_kick();
template void Engine<double>::start_kick_drift_kick();
template void Engine<float>::step_kick_drift_kick();
template void Engine<double>::step_kick_drift_kick();

}  // namespace sluice
