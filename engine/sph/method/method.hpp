#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>

#include "engine/space/vec.hpp"
#include "engine/sph/kernel/discretisation.hpp"
#include "engine/sph/terms/list.hpp"
#include "engine/sph/terms/wall_pressure.hpp"

namespace sluice {

/// Time integration scheme.
enum class Integrator {
  modified_leap_frog,  ///< eqs. 13-17, the paper's
  kick_drift_kick,     ///< Adami et al. 2012: larger stable steps
};

/// Arithmetic of the pair sums. The particles' state is kept in double either way.
enum class Precision { mixed, double_precision };

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

/// Everything the solver must know besides the particles: the scheme and its constants. Each term
/// of terms/list.hpp is an optional member; an empty one is left out: its sum is not computed, its
/// fields are not allocated.
struct Method : Discretisation, OptionalTerms<AllTerms> {
  Integrator integrator = Integrator::modified_leap_frog;
  Precision precision = Precision::mixed;
  double courant = 0.25;  ///< C of eq. 18
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
};

}  // namespace sluice
