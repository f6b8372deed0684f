#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/space/axes.hpp"
#include "engine/space/field_member.hpp"
#include "engine/space/vec.hpp"
#include "engine/sph/method/method.hpp"

namespace sluice {

/// The values of one field, one for each particle.
using Values = std::vector<double>;

/// Fluid particles, structure of arrays. The order of the particles is part of the state: sums run
/// in it. A field that the scheme does not need stays empty; all others have `size()` entries.
template <int Dim>
struct ParticlesN {
  using Axes = PerAxisN<Values, Dim>;

  Axes position;               ///< m
  Axes velocity;               ///< m/s
  Values density_excess;       ///< rho - rho_0, kg/m^3
  Axes velocity_half;          ///< velocity half a step earlier, m/s
  Values density_excess_half;  ///< rho - rho_0 half a step earlier, kg/m^3
  Axes acceleration;           ///< m/s^2
  Axes position_sorted;        ///< position at the last sort, m
  Values id;                   ///< number given at the start; whole, 0 ... N-1

  [[nodiscard]] std::size_t size() const { return position.front().size(); }
  [[nodiscard]] VecN<Dim> position_of(std::size_t i) const { return vector_of(position, i); }
  [[nodiscard]] VecN<Dim> velocity_of(std::size_t i) const { return vector_of(velocity, i); }
};
using Particles = ParticlesN<kAnyDim>;

/// No particles yet, of so many dimensions.
[[nodiscard]] inline Particles no_particles(int dimensions) {
  const Particles::Axes axes(static_cast<std::size_t>(dimensions));
  return {axes, axes, {}, axes, {}, axes, axes, {}};
}

enum class Role {
  state,    ///< needed to go on exactly
  derived,  ///< follows from the state; written for readers only
};

/// Which schemes carry a field.
enum class CarriedBy { every_scheme, modified_leap_frog, kick_drift_kick };

/// What a field holds in a slot of memory that no particle is in.
enum class EmptySlot {
  zero,
  nobody,   ///< kNobody
  nowhere,  ///< a place far from all particles, and from that of every other empty slot
};
/// The id in an empty slot.
inline constexpr double kNobody = -1.0;

template <int Dim>
struct FieldN {
  std::string_view name;
  std::string_view unit;
  std::string_view description;
  Role role;
  CarriedBy carried_by;
  EmptySlot empty;
  FieldMember<ParticlesN<Dim>, Values, typename ParticlesN<Dim>::Axes> values;
};
using Field = FieldN<kAnyDim>;

/// The one list of fields in `Dim` dimensions: memory, reordering, checkpoint and comparison all go
/// by it. `Stored` is the dimension of the particles' type, `Dim` or kAnyDim.
template <int Dim, int Stored = Dim>
struct FieldList;

// clang-format off
template <int Stored>
struct FieldList<2, Stored> {
  using P = ParticlesN<Stored>;
  static constexpr std::array fields{
      FieldN<Stored>{"x", "m", "position, horizontal", Role::state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position, 0}},
      FieldN<Stored>{"y", "m", "position, vertical", Role::state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position, 1}},
      FieldN<Stored>{"vx", "m/s", "velocity, horizontal", Role::state, CarriedBy::every_scheme, EmptySlot::zero, {&P::velocity, 0}},
      FieldN<Stored>{"vy", "m/s", "velocity, vertical", Role::state, CarriedBy::every_scheme, EmptySlot::zero, {&P::velocity, 1}},
      FieldN<Stored>{"density_excess", "kg/m^3", "density less the reference density", Role::state, CarriedBy::every_scheme, EmptySlot::zero, &P::density_excess},
      FieldN<Stored>{"vx_half", "m/s", "velocity half a step earlier, horizontal", Role::state, CarriedBy::modified_leap_frog, EmptySlot::zero, {&P::velocity_half, 0}},
      FieldN<Stored>{"vy_half", "m/s", "velocity half a step earlier, vertical", Role::state, CarriedBy::modified_leap_frog, EmptySlot::zero, {&P::velocity_half, 1}},
      FieldN<Stored>{"density_excess_half", "kg/m^3", "density less the reference density, half a step earlier", Role::state, CarriedBy::modified_leap_frog, EmptySlot::zero, &P::density_excess_half},
      FieldN<Stored>{"ax", "m/s^2", "acceleration, horizontal", Role::state, CarriedBy::kick_drift_kick, EmptySlot::zero, {&P::acceleration, 0}},
      FieldN<Stored>{"ay", "m/s^2", "acceleration, vertical", Role::state, CarriedBy::kick_drift_kick, EmptySlot::zero, {&P::acceleration, 1}},
      FieldN<Stored>{"x_sorted", "m", "position at the last sort, horizontal", Role::state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position_sorted, 0}},
      FieldN<Stored>{"y_sorted", "m", "position at the last sort, vertical", Role::state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position_sorted, 1}},
      FieldN<Stored>{"id", "1", "number given at the start", Role::state, CarriedBy::every_scheme, EmptySlot::nobody, &P::id},
  };
};

template <int Stored>
struct FieldList<3, Stored> {
  using P = ParticlesN<Stored>;
  static constexpr std::array fields{
      FieldN<Stored>{"x", "m", "position along x, horizontal", Role::state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position, 0}},
      FieldN<Stored>{"y", "m", "position along y, vertical", Role::state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position, 1}},
      FieldN<Stored>{"z", "m", "position along z, horizontal", Role::state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position, 2}},
      FieldN<Stored>{"vx", "m/s", "velocity along x", Role::state, CarriedBy::every_scheme, EmptySlot::zero, {&P::velocity, 0}},
      FieldN<Stored>{"vy", "m/s", "velocity along y", Role::state, CarriedBy::every_scheme, EmptySlot::zero, {&P::velocity, 1}},
      FieldN<Stored>{"vz", "m/s", "velocity along z", Role::state, CarriedBy::every_scheme, EmptySlot::zero, {&P::velocity, 2}},
      FieldN<Stored>{"density_excess", "kg/m^3", "density less the reference density", Role::state, CarriedBy::every_scheme, EmptySlot::zero, &P::density_excess},
      FieldN<Stored>{"vx_half", "m/s", "velocity half a step earlier, along x", Role::state, CarriedBy::modified_leap_frog, EmptySlot::zero, {&P::velocity_half, 0}},
      FieldN<Stored>{"vy_half", "m/s", "velocity half a step earlier, along y", Role::state, CarriedBy::modified_leap_frog, EmptySlot::zero, {&P::velocity_half, 1}},
      FieldN<Stored>{"vz_half", "m/s", "velocity half a step earlier, along z", Role::state, CarriedBy::modified_leap_frog, EmptySlot::zero, {&P::velocity_half, 2}},
      FieldN<Stored>{"density_excess_half", "kg/m^3", "density less the reference density, half a step earlier", Role::state, CarriedBy::modified_leap_frog, EmptySlot::zero, &P::density_excess_half},
      FieldN<Stored>{"ax", "m/s^2", "acceleration along x", Role::state, CarriedBy::kick_drift_kick, EmptySlot::zero, {&P::acceleration, 0}},
      FieldN<Stored>{"ay", "m/s^2", "acceleration along y", Role::state, CarriedBy::kick_drift_kick, EmptySlot::zero, {&P::acceleration, 1}},
      FieldN<Stored>{"az", "m/s^2", "acceleration along z", Role::state, CarriedBy::kick_drift_kick, EmptySlot::zero, {&P::acceleration, 2}},
      FieldN<Stored>{"x_sorted", "m", "position at the last sort, along x", Role::state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position_sorted, 0}},
      FieldN<Stored>{"y_sorted", "m", "position at the last sort, along y", Role::state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position_sorted, 1}},
      FieldN<Stored>{"z_sorted", "m", "position at the last sort, along z", Role::state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position_sorted, 2}},
      FieldN<Stored>{"id", "1", "number given at the start", Role::state, CarriedBy::every_scheme, EmptySlot::nobody, &P::id},
  };
};
// clang-format on

/// The list for particles whose type does not say how many dimensions they have.
[[nodiscard]] constexpr std::span<const Field> fields_in(std::size_t dimensions) {
  if (dimensions == 2) return FieldList<2, kAnyDim>::fields;
  return FieldList<3, kAnyDim>::fields;
}

/// Whether particles of this integrator carry the field.
template <int Dim>
[[nodiscard]] constexpr bool carries(Integrator integrator, const FieldN<Dim>& field) {
  switch (field.carried_by) {
    case CarriedBy::every_scheme:
      return true;
    case CarriedBy::modified_leap_frog:
      return integrator == Integrator::modified_leap_frog;
    case CarriedBy::kick_drift_kick:
      return integrator == Integrator::kick_drift_kick;
  }
  return false;
}

/// Why a particle left the sums: where it went, or, from not_finite on, because it became what the
/// scheme cannot hold, and was excluded.
enum class RemovalCause {
  overtopped,  ///< over the rim of an open tank
  leaked,      ///< into or through a solid, or over the edge of the domain
  not_finite,  ///< a place, velocity or density that is no number
  too_fast,    ///< than sound
  too_dense,   ///< rho/rho_0 above 1 + Method::kDensityLeeway
  too_thin,    ///< rho/rho_0 below 1 - Method::kDensityLeeway
};
inline constexpr std::size_t kRemovalCauses = 6;
[[nodiscard]] constexpr bool is_exclusion(RemovalCause cause) {
  return cause >= RemovalCause::not_finite;
}
[[nodiscard]] std::string_view to_string(RemovalCause cause);

/// A particle that left the sums, as it was then. What was not finite is 0, a place that of the
/// last sort. Velocities and densities are 0 in what builds before the exclusion wrote.
template <int Dim>
struct RemovedParticleN {
  double id = 0;
  RemovalCause cause = RemovalCause::leaked;
  std::uint64_t step = 0;
  double time = 0.0;                          ///< s
  VecN<Dim> position = filled_vec<Dim>(0.0);  ///< m
  VecN<Dim> velocity = filled_vec<Dim>(0.0);  ///< m/s
  double density_excess = 0.0;                ///< kg/m^3
};
using RemovedParticle = RemovedParticleN<kAnyDim>;

struct RemovedField {
  std::string_view name;
  std::string_view unit;
  std::string_view description;
  FieldMember<RemovedParticle, double, Vec> value;
};

/// What a removed particle was, beside who, when and why.
// clang-format off
template <int Dim>
struct RemovedFieldList;
template <>
struct RemovedFieldList<2> {
  static constexpr std::array fields{
      RemovedField{"x", "m", "last position, horizontal", {&RemovedParticle::position, 0}},
      RemovedField{"y", "m", "last position, vertical", {&RemovedParticle::position, 1}},
      RemovedField{"vx", "m/s", "last velocity, horizontal", {&RemovedParticle::velocity, 0}},
      RemovedField{"vy", "m/s", "last velocity, vertical", {&RemovedParticle::velocity, 1}},
      RemovedField{"density_excess", "kg/m^3", "last density less the reference density", &RemovedParticle::density_excess},
  };
};
template <>
struct RemovedFieldList<3> {
  static constexpr std::array fields{
      RemovedField{"x", "m", "last position along x, horizontal", {&RemovedParticle::position, 0}},
      RemovedField{"y", "m", "last position along y, vertical", {&RemovedParticle::position, 1}},
      RemovedField{"z", "m", "last position along z, horizontal", {&RemovedParticle::position, 2}},
      RemovedField{"vx", "m/s", "last velocity along x", {&RemovedParticle::velocity, 0}},
      RemovedField{"vy", "m/s", "last velocity along y", {&RemovedParticle::velocity, 1}},
      RemovedField{"vz", "m/s", "last velocity along z", {&RemovedParticle::velocity, 2}},
      RemovedField{"density_excess", "kg/m^3", "last density less the reference density", &RemovedParticle::density_excess},
  };
};
// clang-format on
[[nodiscard]] constexpr std::span<const RemovedField> removed_fields_in(std::size_t dimensions) {
  if (dimensions == 2) return RemovedFieldList<2>::fields;
  return RemovedFieldList<3>::fields;
}

/// Everything the solver needs to go on as if it had never stopped.
template <int Dim>
struct SolverStateN {
  ParticlesN<Dim> particles;
  std::uint64_t step = 0;
  double time = 0.0;       ///< model time t^n, s
  double time_step = 0.0;  ///< length of the step that led here, s; 0 before the first
  std::vector<RemovedParticleN<Dim>> removed;
};
using SolverState = SolverStateN<kAnyDim>;

/// The same for another type of vectors, of as many dimensions.
template <int To, int From>
[[nodiscard]] RemovedParticleN<To> removed_as(const RemovedParticleN<From>& from) {
  return {from.id,       from.cause,    from.step,          from.time,
          from.position, from.velocity, from.density_excess};
}
template <int To, int From>
[[nodiscard]] SolverStateN<To> state_as(SolverStateN<From> from) {
  ParticlesN<From>& p = from.particles;
  SolverStateN<To> to;
  to.particles = {moved_axes<To>(std::move(p.position)),
                  moved_axes<To>(std::move(p.velocity)),
                  std::move(p.density_excess),
                  moved_axes<To>(std::move(p.velocity_half)),
                  std::move(p.density_excess_half),
                  moved_axes<To>(std::move(p.acceleration)),
                  moved_axes<To>(std::move(p.position_sorted)),
                  std::move(p.id)};
  to.step = from.step;
  to.time = from.time;
  to.time_step = from.time_step;
  for (const RemovedParticleN<From>& each : from.removed) {
    to.removed.push_back(removed_as<To>(each));
  }
  return to;
}

/// Of the fluid, J, in the plane per metre of depth: kinetic m v^2/2, potential -m f . x, and
/// internal m c^2 (ln(rho/rho_0) + rho_0/rho - 1), the integral of p/rho^2 of the linear equation
/// of state.
struct Energy {
  double kinetic = 0.0;
  double potential = 0.0;
  double internal = 0.0;

  [[nodiscard]] double total() const { return kinetic + potential + internal; }
  void merge(const Energy& other) {
    kinetic += other.kinetic;
    potential += other.potential;
    internal += other.internal;
  }
};

}  // namespace sluice
