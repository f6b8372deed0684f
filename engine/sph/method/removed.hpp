#pragma once

#include <optional>
#include <span>

#include "engine/sph/method/flow_domain.hpp"
#include "engine/sph/method/method.hpp"
#include "engine/sph/method/particles.hpp"

namespace sluice {

/// Why the particle in a slot is no part of the fluid any more at time t, if so: it is what the
/// scheme cannot hold, or where the run does not go on, or in a solid.
template <int Dim>
[[nodiscard]] std::optional<RemovalCause> cause_to_remove(const MethodN<Dim>& method,
                                                          const FlowDomainN<Dim>& domain,
                                                          const ParticlesN<Dim>& particles,
                                                          std::size_t slot, double time);

/// What is kept of the particle. Of what is not finite: the place at the last sort, or zero.
template <int Dim>
[[nodiscard]] RemovedParticleN<Dim> record_of(const ParticlesN<Dim>& particles, std::size_t slot,
                                              RemovalCause cause, std::uint64_t step, double time);

/// Energy that a particle took along, J/m.
[[nodiscard]] Energy energy_of(const Method& method, const RemovedParticle& removed);

/// All that particles of one kind took along when they left the sums.
struct Departed {
  std::size_t count = 0;
  double mass = 0.0;                        ///< kg/m
  Vec momentum = filled_vec<kAnyDim>(0.0);  ///< kg m/s
  Energy energy;

  void add(const Method& method, const RemovedParticle& removed);
  void merge(const Departed& other);
};

}  // namespace sluice
