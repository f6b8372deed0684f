#include "engine/sph/solver/engine_of.hpp"
#include "engine/sph/solver/term_constants.hpp"

namespace sluice {

template <typename T>
PairScales Engine<T>::scales() const {
  PairScales k;
  k.inverse_length = 1.0 / method.smoothing_length;
  k.inverse_speed = 1.0 / method.sound_speed;
  k.inverse_density = 1.0 / method.reference_density;
  if (keeps_diffused(method)) {
    k.hydrostatic = method.gravity / (method.sound_speed * method.sound_speed);
    k.hydrostatic_middle = k.hydrostatic.dot(domain.box.min + domain.box.max) / 2.0;
  }
  k.grid = &grid_;
  k.origin_cell = bounds.origin_cell.data();
  return k;
}

template <typename T>
void Engine<T>::sweep_chunk(typename Sweeps<T>::Sweep loop, std::size_t chunk) {
  SweepTask<T> task;
  task.self = pairs_.view();
  task.fluid = task.self;
  task.wall = walls_.view();
  task.to_fluid = &fluid_to_fluid_.chunks[chunk];
  task.to_wall = !walls_.empty() ? &fluid_to_wall_.chunks[chunk] : nullptr;
  task.first_cluster = layout.chunk_begin(chunk);
  task.clusters = layout.chunk_begin(chunk + 1) - task.first_cluster;
  task.constants = &constants_;
  task.sums = sums_.of(chunk);
  loop(task);
}

/// Adds up, in a fixed order, what a sweep left for the particles of a chunk.
template <typename T>
Rates<T> Engine<T>::gather(const ParticleSpan& chunk, const SumBlocks& blocks) {
  const std::size_t n = chunk.begin / (kCluster * layout.chunk);
  sweeps_.updates.gather(sums_.contributions(n), sums_.of_chunks(), blocks.stride, sums_.of(n));
  return rates_of(chunk, blocks);
}

/// What gather() left.
template <typename T>
Rates<T> Engine<T>::rates_of(const ParticleSpan& chunk, const SumBlocks& blocks) const {
  // Times c/h and c^2/h.
  const double scale = scale_of_sums(method) * method.sound_speed / method.smoothing_length;
  return {sums_.of(chunk.begin / (kCluster * layout.chunk)),
          chunk.begin,
          blocks,
          scale * method.reference_density,
          scale * method.sound_speed,
          method.gravity};
}

template <typename T>
void Engine<T>::sum_wall_pressure() {
  if (walls_.empty()) return;
  const PassClock clock(seconds_of(Pass::wall_pressure));
  walls_.sum_pressures(team_, method, sweeps_, constants_, pairs_.view(), wall_to_fluid_);
}

template <typename T>
bool Engine<T>::reinitialisation_due(std::uint64_t step) const {
  return method.reinitialisation && step > 0 &&
         step % static_cast<std::uint64_t>(method.reinitialisation->interval) == 0;
}

template <typename T>
void Engine<T>::reinitialise() {
  sweep(sweeps_.reinitialise, kReinitialisationSums,
        [&](const ParticleSpan& p, const Rates<T>& rates, Motion&) {
          sweeps_.updates.reinitialise(p, rates, method.reference_density);
          sweeps_.updates.write_densities(p, scales_, pairs_);
          if (pairs_.diffused.size() > 0) sweeps_.updates.write_places(p, scales_, pairs_);
        },
        {Pass::reinitialisation, Pass::reinitialisation});
}

template <typename T>
void Engine<T>::write_pairs(const ParticleSpan& p) {
  sweeps_.updates.write_places(p, scales_, pairs_);
  sweeps_.updates.write_velocities(p, scales_, pairs_);
  sweeps_.updates.write_densities(p, scales_, pairs_);
}

template PairScales Engine<float>::scales() const;
template PairScales Engine<double>::scales() const;
template void Engine<float>::sweep_chunk(typename Sweeps<float>::Sweep, std::size_t);
template void Engine<double>::sweep_chunk(typename Sweeps<double>::Sweep, std::size_t);
template Rates<float> Engine<float>::gather(const ParticleSpan&, const SumBlocks&);
template Rates<double> Engine<double>::gather(const ParticleSpan&, const SumBlocks&);
template Rates<float> Engine<float>::rates_of(const ParticleSpan&, const SumBlocks&) const;
template Rates<double> Engine<double>::rates_of(const ParticleSpan&, const SumBlocks&) const;
template void Engine<float>::sum_wall_pressure();
template void Engine<double>::sum_wall_pressure();
template bool Engine<float>::reinitialisation_due(std::uint64_t) const;
template bool Engine<double>::reinitialisation_due(std::uint64_t) const;
template void Engine<float>::reinitialise();
template void Engine<double>::reinitialise();
template void Engine<float>::write_pairs(const ParticleSpan&);
template void Engine<double>::write_pairs(const ParticleSpan&);

}  // namespace sluice
