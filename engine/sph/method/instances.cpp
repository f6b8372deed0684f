// The templates of this room for the dimensions that runs have.

#include "engine/sph/method/removed-inl.hpp"

namespace sluice {

template std::optional<RemovalCause> cause_to_remove(const MethodN<2>&, const FlowDomainN<2>&,
                                                     const ParticlesN<2>&, std::size_t, double);
template RemovedParticleN<2> record_of(const ParticlesN<2>&, std::size_t, RemovalCause,
                                       std::uint64_t, double);
template std::optional<RemovalCause> cause_to_remove(const MethodN<3>&, const FlowDomainN<3>&,
                                                     const ParticlesN<3>&, std::size_t, double);
template RemovedParticleN<3> record_of(const ParticlesN<3>&, std::size_t, RemovalCause,
                                       std::uint64_t, double);

}  // namespace sluice
