#pragma once

#include <cmath>

#include "engine/space/space_traits.hpp"
#include "engine/sph/method/removed.hpp"

namespace sluice {
namespace removal {

template <int Dim>
std::optional<RemovalCause> cause_to_exclude(const MethodN<Dim>& method, const VecN<Dim>& place,
                                             const VecN<Dim>& velocity, double density_excess) {
  if (!place.allFinite() || !velocity.allFinite() || !std::isfinite(density_excess)) {
    return RemovalCause::not_finite;
  }
  if (!(velocity.squaredNorm() <= method.sound_speed * method.sound_speed)) {
    return RemovalCause::too_fast;
  }
  if (std::abs(density_excess) <= method.most_density_excess()) return {};
  return density_excess > 0.0 ? RemovalCause::too_dense : RemovalCause::too_thin;
}

inline double finite_or(double value, double otherwise) {
  return std::isfinite(value) ? value : otherwise;
}

}  // namespace removal

template <int Dim>
std::optional<RemovalCause> cause_to_remove(const MethodN<Dim>& method,
                                            const FlowDomainN<Dim>& domain,
                                            const ParticlesN<Dim>& p, std::size_t slot,
                                            double time) {
  const VecN<Dim> place = p.position_of(slot);
  const auto unfit =
      removal::cause_to_exclude<Dim>(method, place, p.velocity_of(slot), p.density_excess[slot]);
  if (unfit) return unfit;
  if (!domain.keeps(place)) {
    return place[kUpAxis] >= domain.over_from() ? RemovalCause::overtopped : RemovalCause::leaked;
  }
  if (domain.in_solid && domain.in_solid(place, time)) return RemovalCause::leaked;
  return {};
}

template <int Dim>
RemovedParticleN<Dim> record_of(const ParticlesN<Dim>& p, std::size_t slot, RemovalCause cause,
                                std::uint64_t step, double time) {
  RemovedParticleN<Dim> record;
  record.id = p.id[slot];
  record.cause = cause;
  record.step = step;
  record.time = time;
  for (std::size_t axis = 0; axis < p.position.size(); ++axis) {
    record.position[static_cast<Eigen::Index>(axis)] = removal::finite_or(
        p.position[axis][slot], removal::finite_or(p.position_sorted[axis][slot], 0.0));
  }
  const VecN<Dim> velocity = p.velocity_of(slot);
  if (velocity.allFinite()) record.velocity = velocity;
  record.density_excess = removal::finite_or(p.density_excess[slot], 0.0);
  return record;
}

}  // namespace sluice
