#pragma once

#include "engine/sph/solver/engine_of.hpp"
#include "engine/sph/solver/term_constants.hpp"

namespace sluice {

template <typename T, int Dim>
PairScales<Dim> Engine<T, Dim>::scales() const {
  PairScales<Dim> k;
  k.inverse_length = 1.0 / method_.smoothing_length;
  k.inverse_speed = 1.0 / method_.sound_speed;
  k.inverse_density = 1.0 / method_.reference_density;
  if (keeps_diffused(method_)) {
    k.hydrostatic = method_.gravity / (method_.sound_speed * method_.sound_speed);
    k.hydrostatic_middle = k.hydrostatic.dot(domain_.box.min + domain_.box.max) / 2.0;
  }
  k.grid = &grid_;
  k.origin_cell = bounds_.origin_cell.data();
  return k;
}

template <typename T, int Dim>
void Engine<T, Dim>::sweep_chunk(Sweep loop, std::size_t chunk) {
  SweepTask<T, Dim> task;
  task.self = pairs_.view();
  task.fluid = task.self;
  task.wall = walls_.view();
  task.to_fluid = &fluid_to_fluid_.chunks[chunk];
  task.to_wall = !walls_.empty() ? &fluid_to_wall_.chunks[chunk] : nullptr;
  task.first_cluster = layout_.chunk_begin(chunk);
  task.clusters = layout_.chunk_begin(chunk + 1) - task.first_cluster;
  task.constants = &constants_;
  task.sums = sums_.of(chunk);
  loop(task);
}

/// Adds up, in a fixed order, what a sweep left for the particles of a chunk.
template <typename T, int Dim>
Rates<T, Dim> Engine<T, Dim>::gather(const Span& chunk, const Blocks& blocks) {
  const std::size_t n = chunk.begin / (kCluster * layout_.chunk);
  sweeps_.updates.gather(sums_.contributions(n), sums_.of_chunks(), blocks.stride, sums_.of(n));
  return rates_of(chunk, blocks);
}

/// What gather() left.
template <typename T, int Dim>
Rates<T, Dim> Engine<T, Dim>::rates_of(const Span& chunk, const Blocks& blocks) const {
  // Times c/h and c^2/h.
  const double scale = scale_of_sums(method_) * method_.sound_speed / method_.smoothing_length;
  return {sums_.of(chunk.begin / (kCluster * layout_.chunk)),
          chunk.begin,
          blocks,
          scale * method_.reference_density,
          scale * method_.sound_speed,
          method_.gravity};
}

template <typename T, int Dim>
void Engine<T, Dim>::sum_wall_pressure() {
  if (walls_.empty()) return;
  const PassClock clock(seconds_of(Pass::wall_pressure));
  walls_.sum_pressures(team_, method_, sweeps_, constants_, pairs_.view(), wall_to_fluid_);
}

template <typename T, int Dim>
bool Engine<T, Dim>::reinitialisation_due(std::uint64_t step) const {
  return method_.reinitialisation && step > 0 &&
         step % static_cast<std::uint64_t>(method_.reinitialisation->interval) == 0;
}

template <typename T, int Dim>
void Engine<T, Dim>::reinitialise() {
  sweep(sweeps_.reinitialise, kReinitialisationSums<Dim>,
        [&](const Span& p, const ChunkRates& rates, Motion&) {
          sweeps_.updates.reinitialise(p, rates, method_.reference_density);
          sweeps_.updates.write_densities(p, scales_, pairs_);
          if (pairs_.keeps_diffused()) sweeps_.updates.write_places(p, scales_, pairs_);
        },
        {Pass::reinitialisation, Pass::reinitialisation});
}

template <typename T, int Dim>
void Engine<T, Dim>::write_pairs(const Span& p) {
  sweeps_.updates.write_places(p, scales_, pairs_);
  sweeps_.updates.write_velocities(p, scales_, pairs_);
  sweeps_.updates.write_densities(p, scales_, pairs_);
}

}  // namespace sluice
