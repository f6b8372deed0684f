#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "engine/space/space_traits.hpp"
#include "engine/space/vec.hpp"

namespace sluice {

/// Smoothing function W(R, h), R = |x_ij| / h.
enum class KernelKind {
  truncated_gaussian,  ///< eq. 6: pi^(-d/2) h^-d exp(-R^2), R < 3
  wendland_c2,         ///< norm h^-d (1 - R/2)^4 (2R + 1), R < 2; 7/(4 pi) in the plane
};

/// Time integration scheme.
enum class Integrator {
  modified_leap_frog,  ///< eqs. 13-17, the paper's
  kick_drift_kick,     ///< Adami et al. 2012: larger stable steps
};

/// Arithmetic of the pair sums. The particles' state is kept in double either way.
enum class Precision { mixed, double_precision };

/// What is diffused by the density diffusion term D_i.
enum class DiffusionKind {
  molteni_colagrossi,  ///< eq. 7: the density
  fourtakas,           ///< the density less its hydrostatic part
};

/// D_i of eq. 7 with the neighbour's volume; `delta` is dimensionless.
struct DensityDiffusion {
  DiffusionKind kind = DiffusionKind::molteni_colagrossi;
  double delta = 0.1;
};

/// Pi_ij of eq. 8 and, with `beta`, its quadratic part (Monaghan 1992), which acts where particles
/// collide and keeps them from running into each other. All dimensionless.
struct ArtificialViscosity {
  double alpha = 0.02;
  double epsilon = 0.01;
  double beta = 0.0;  ///< 0: the quadratic part is left out
};

/// Pi_ij of eq. 8 summed against resting walls: a friction that the paper's free slip leaves out.
struct WallArtificialViscosity {
  double alpha = 0.02;
  double epsilon = 0.01;
};

/// Laminar viscous stress with no slip at walls (Morris et al. 1997): water's nu, or that of a
/// turbulent flow (eddy viscosity). Unlike eq. 8 it does not depend on the particle distance.
struct LaminarViscosity {
  double nu = 1e-6;  ///< kinematic viscosity, m^2/s
};

/// Wall law: the stress Cf/2 rho_0 |v| v of a turbulent boundary layer too thin to be resolved. It
/// depends on neither the particle distance nor any scale of the flow.
struct WallShear {
  double coefficient = 0.01;  ///< skin friction coefficient Cf, dimensionless
};

/// Particle shifting (Lind et al. 2012, as Skillen et al. 2013 scale it with the speed): a particle
/// inside the fluid moves by -A h |v| dt grad C, C the concentration of particles, so that no
/// gaps open along streamlines. One at a free surface stays.
struct ParticleShifting {
  double coefficient = 2.0;  ///< A, dimensionless

  /// Particles are shifted in every so many steps, for the dt of all: gaps open slowly.
  static constexpr std::uint64_t kInterval = 2;
};

/// A wall that is lifted out of the tank from t = 0 on: the dummy particles in `place` stand still,
/// and go row by row as the lower edge passes them. Nothing of it is state: it follows from t.
struct GateMotion {
  Box place;           ///< m
  double speed = 0.0;  ///< upwards, m/s

  /// Whether a dummy particle there is gone at time t.
  [[nodiscard]] bool has_passed(const Vec& p, double t) const {
    return place.contains(p) && p.y() < place.min.y() + speed * t;
  }
};

/// Shepard density reinitialisation, eq. 10, every `interval` steps.
struct Reinitialisation {
  int interval = 20;
};

/// Pressure of dummy particles, eq. 9.
enum class WallPressure {
  extrapolated,  ///< as printed: may be negative
  clamped,       ///< not below zero
};

/// Everything the solver must know besides the particles: the scheme and its constants. An empty
/// optional is a term that is left out: its sum is not computed, its fields are not allocated.
struct Method {
  double spacing = 0.0;            ///< initial particle distance dx, m
  double smoothing_length = 0.0;   ///< h, m
  double reference_density = 0.0;  ///< rho_0, kg/m^3
  double sound_speed = 0.0;        ///< numerical speed of sound c, m/s
  Vec gravity = Vec::Zero();       ///< body acceleration f, m/s^2; zero: no gravity
  KernelKind kernel = KernelKind::truncated_gaussian;
  Integrator integrator = Integrator::modified_leap_frog;
  Precision precision = Precision::mixed;
  double courant = 0.25;  ///< C of eq. 18
  std::optional<DensityDiffusion> diffusion;
  std::optional<ArtificialViscosity> viscosity;
  std::optional<WallArtificialViscosity> wall_artificial_viscosity;
  std::optional<LaminarViscosity> laminar_viscosity;
  std::optional<WallShear> wall_shear;       ///< at most one of these three
  std::optional<ParticleShifting> shifting;  ///< with kick_drift_kick only
  std::optional<Reinitialisation> reinitialisation;
  WallPressure wall_pressure = WallPressure::extrapolated;
  std::optional<GateMotion> gate;
  Box domain;                      ///< a particle that leaves it is removed
  std::optional<double> wall_top;  ///< m; leaving above it is overtopping, below it a leak; absent:
                                   ///< no open tank
  /// m; outside of these x a particle is over the wall from over_from() on and removed at once, so
  /// that what falls down behind a wall is not taken for a leak.
  double rim_left = -std::numeric_limits<double>::infinity();
  double rim_right = std::numeric_limits<double>::infinity();

  /// m; what is outside of the room and below this height is deep in a wall of the tank. Of an open
  /// tank that is a little below wall_top: what comes over a rim may lie down on it.
  Box room{Vec::Constant(-std::numeric_limits<double>::infinity()),
           Vec::Constant(std::numeric_limits<double>::infinity())};
  double walls_reach = std::numeric_limits<double>::infinity();
  /// Whether a place is in an obstacle or in the gate at time t; empty: there is none. Asked once
  /// in a while for each particle, on any thread.
  std::function<bool(const Vec&, double t)> in_solid;

  /// A particle is excluded whose density is farther than this from rho_0, over rho_0.
  static constexpr double kDensityLeeway = 0.3;
  [[nodiscard]] double most_density_excess() const { return kDensityLeeway * reference_density; }

  /// No step is shorter, s: 0.05 h/c, in proportion less for a Courant number below the paper's
  /// 0.25. Only an acceleration of more than 25 c^2/h asks for less, and a particle that has it is
  /// faster than sound after such a step, and excluded: it does not hold up all others.
  [[nodiscard]] double least_time_step() const {
    return 0.05 * std::min(1.0, courant / 0.25) * smoothing_length / sound_speed;
  }

  /// Height from which on a particle beyond a rim's middle is over it, m: little below wall_top,
  /// for what runs over a rim sinks into its outer edge.
  [[nodiscard]] double over_from() const {
    return wall_top ? std::min(*wall_top, walls_reach) : std::numeric_limits<double>::infinity();
  }
  /// Whether a particle there stays in the run.
  [[nodiscard]] bool keeps(const Vec& p) const {
    const bool over = p.y() >= over_from() && !(p.x() >= rim_left && p.x() <= rim_right);
    const bool in_wall = p.y() < walls_reach && !room.contains(p);
    return domain.contains(p) && !over && !in_wall;
  }
  /// Mass of every particle, fluid and dummy, kg per metre of depth: rho_0 dx^d.
  [[nodiscard]] double particle_mass() const {
    return times_power<kDim>(reference_density, spacing);
  }
  /// 2 nu/(c h): the physical viscosity in the units of the sums; 0 without it.
  [[nodiscard]] double scaled_two_nu() const {
    return laminar_viscosity ? 2.0 * laminar_viscosity->nu / (sound_speed * smoothing_length) : 0.0;
  }
  /// Distance at which W becomes zero, in smoothing lengths.
  [[nodiscard]] double support_ratio() const {
    return kernel == KernelKind::truncated_gaussian ? 3.0 : 2.0;
  }
  [[nodiscard]] double support() const { return support_ratio() * smoothing_length; }
};

}  // namespace sluice
