#include "engine/sph/method/removed.hpp"

#include <cmath>

namespace sluice {
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
  if (count == 0) momentum = filled_vec<kAnyDim>(0.0, method.dimensions());
  ++count;
  mass += method.particle_mass();
  momentum += method.particle_mass() * removed.velocity;
  energy.merge(energy_of(method, removed));
}

void Departed::merge(const Departed& other) {
  if (momentum.size() != other.momentum.size())
    momentum = filled_vec<kAnyDim>(0.0, dimensions_of(other.momentum));
  count += other.count;
  mass += other.mass;
  momentum += other.momentum;
  energy.merge(other.energy);
}

}  // namespace sluice
