#pragma once

#include "engine/space/space_traits.hpp"
#include "engine/space/vec.hpp"
#include "engine/sph/kernel/kernel.hpp"

namespace sluice {

/// A fluid and how it is cut into particles: all that the constants of a term may follow from.
template <int Dim>
struct DiscretisationN {
  double spacing = 0.0;                   ///< initial particle distance dx, m
  double smoothing_length = 0.0;          ///< h, m
  double reference_density = 0.0;         ///< rho_0, kg/m^3
  double sound_speed = 0.0;               ///< numerical speed of sound c, m/s
  VecN<Dim> gravity = VecN<Dim>::Zero();  ///< body acceleration f, m/s^2; zero: no gravity
  KernelKind kernel = KernelKind::truncated_gaussian;

  /// Mass of every particle, fluid and dummy, kg, in the plane per metre of depth: rho_0 dx^d.
  [[nodiscard]] double particle_mass() const {
    return times_power<Dim>(reference_density, spacing);
  }
  /// Distance at which W becomes zero, in smoothing lengths.
  [[nodiscard]] double support_ratio() const { return kernel_support(kernel); }
  [[nodiscard]] double support() const { return support_ratio() * smoothing_length; }
};

using Discretisation = DiscretisationN<kDim>;

}  // namespace sluice
