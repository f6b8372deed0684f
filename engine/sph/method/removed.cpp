#include "engine/sph/method/removed.hpp"

#include <cmath>

namespace sluice {
namespace {

std::optional<RemovalCause> cause_to_exclude(const Method& method, const Vec& place,
                                             const Vec& velocity, double density_excess) {
  if (!place.allFinite() || !velocity.allFinite() || !std::isfinite(density_excess)) {
    return RemovalCause::not_finite;
  }
  if (!(velocity.squaredNorm() <= method.sound_speed * method.sound_speed)) {
    return RemovalCause::too_fast;
  }
  if (std::abs(density_excess) <= method.most_density_excess()) return {};
  return density_excess > 0.0 ? RemovalCause::too_dense : RemovalCause::too_thin;
}

double finite_or(double value, double otherwise) {
  return std::isfinite(value) ? value : otherwise;
}

}  // namespace

std::string_view to_string(RemovalCause cause) {
  switch (cause) {
    case RemovalCause::overtopped:
      return "overtopped";
    case RemovalCause::leaked:
      return "leaked";
    case RemovalCause::not_finite:
      return "not finite";
    case RemovalCause::too_fast:
      return "too fast";
    case RemovalCause::too_dense:
      return "too dense";
    case RemovalCause::too_thin:
      return "too thin";
  }
  return "";
}

std::optional<RemovalCause> cause_to_remove(const Method& method, const FlowDomain& domain,
                                            const Particles& p, std::size_t slot, double time) {
  const Vec place = p.position_of(slot);
  const auto unfit = cause_to_exclude(method, place, p.velocity_of(slot), p.density_excess[slot]);
  if (unfit) return unfit;
  if (!domain.keeps(place)) {
    return place.y() >= domain.over_from() ? RemovalCause::overtopped : RemovalCause::leaked;
  }
  if (domain.in_solid && domain.in_solid(place, time)) return RemovalCause::leaked;
  return {};
}

RemovedParticle record_of(const Particles& p, std::size_t slot, RemovalCause cause,
                          std::uint64_t step, double time) {
  RemovedParticle record;
  record.id = p.id[slot];
  record.cause = cause;
  record.step = step;
  record.time = time;
  for (std::size_t axis = 0; axis < p.position.size(); ++axis) {
    record.position[static_cast<Eigen::Index>(axis)] =
        finite_or(p.position[axis][slot], finite_or(p.position_sorted[axis][slot], 0.0));
  }
  const Vec velocity = p.velocity_of(slot);
  if (velocity.allFinite()) record.velocity = velocity;
  record.density_excess = finite_or(p.density_excess[slot], 0.0);
  return record;
}

Energy energy_of(const Method& method, const RemovedParticle& removed) {
  const double mass = method.particle_mass();
  const double compression = removed.density_excess / method.reference_density;
  Energy energy;
  energy.kinetic = 0.5 * mass * removed.velocity.squaredNorm();
  energy.potential = -mass * method.gravity.dot(removed.position);
  // Below no density at all there is no such integral.
  if (compression > -1.0) {
    energy.internal = mass * method.sound_speed * method.sound_speed *
                      (std::log1p(compression) - compression / (1.0 + compression));
  }
  return energy;
}

void Departed::add(const Method& method, const RemovedParticle& removed) {
  ++count;
  mass += method.particle_mass();
  momentum += method.particle_mass() * removed.velocity;
  energy.merge(energy_of(method, removed));
}

void Departed::merge(const Departed& other) {
  count += other.count;
  mass += other.mass;
  momentum += other.momentum;
  energy.merge(other.energy);
}

}  // namespace sluice
