#include "engine/sph/method/retired.hpp"

#include <cmath>

namespace sluice {
namespace {

std::optional<RetireCause> cause_to_exclude(const Method& method, const Vec& place,
                                            const Vec& velocity, double density_excess) {
  if (!place.allFinite() || !velocity.allFinite() || !std::isfinite(density_excess)) {
    return RetireCause::not_finite;
  }
  if (!(velocity.squaredNorm() <= method.sound_speed * method.sound_speed)) {
    return RetireCause::too_fast;
  }
  if (std::abs(density_excess) <= method.most_density_excess()) return {};
  return density_excess > 0.0 ? RetireCause::too_dense : RetireCause::too_thin;
}

double finite_or(double value, double otherwise) {
  return std::isfinite(value) ? value : otherwise;
}

}  // namespace

std::string_view to_string(RetireCause cause) {
  switch (cause) {
    case RetireCause::overtopped:
      return "overtopped";
    case RetireCause::leaked:
      return "leaked";
    case RetireCause::not_finite:
      return "not finite";
    case RetireCause::too_fast:
      return "too fast";
    case RetireCause::too_dense:
      return "too dense";
    case RetireCause::too_thin:
      return "too thin";
  }
  return "";
}

std::optional<RetireCause> cause_to_retire(const Method& method, const Particles& p,
                                           std::size_t slot, double time) {
  const Vec place = p.position(slot);
  const auto unfit = cause_to_exclude(method, place, p.velocity(slot), p.density_excess[slot]);
  if (unfit) return unfit;
  if (!method.keeps(place)) {
    return place.y() >= method.over_from() ? RetireCause::overtopped : RetireCause::leaked;
  }
  if (method.in_solid && method.in_solid(place, time)) return RetireCause::leaked;
  return {};
}

Retired record_of(const Particles& p, std::size_t slot, RetireCause cause, std::uint64_t step,
                  double time) {
  Retired record;
  record.id = p.id[slot];
  record.cause = cause;
  record.step = step;
  record.time = time;
  record.x = finite_or(p.x[slot], finite_or(p.x_sorted[slot], 0.0));
  record.y = finite_or(p.y[slot], finite_or(p.y_sorted[slot], 0.0));
  if (p.velocity(slot).allFinite()) {
    record.vx = p.vx[slot];
    record.vy = p.vy[slot];
  }
  record.density_excess = finite_or(p.density_excess[slot], 0.0);
  return record;
}

Energy energy_of(const Method& method, const Retired& retired) {
  const double mass = method.particle_mass();
  const double compression = retired.density_excess / method.reference_density;
  Energy energy;
  energy.kinetic = 0.5 * mass * (retired.vx * retired.vx + retired.vy * retired.vy);
  energy.potential = -mass * method.gravity.dot(Vec(retired.x, retired.y));
  // Below no density at all there is no such integral.
  if (compression > -1.0) {
    energy.internal = mass * method.sound_speed * method.sound_speed *
                      (std::log1p(compression) - compression / (1.0 + compression));
  }
  return energy;
}

void Departed::add(const Method& method, const Retired& retired) {
  ++count;
  mass += method.particle_mass();
  momentum += method.particle_mass() * Vec(retired.vx, retired.vy);
  energy.merge(energy_of(method, retired));
}

void Departed::merge(const Departed& other) {
  count += other.count;
  mass += other.mass;
  momentum += other.momentum;
  energy.merge(other.energy);
}

}  // namespace sluice
