#pragma once

#include <vector>

#include "engine/sph/method/method.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {

// The sums of the method as plain double loops over all pairs, in SI units, from the equations as
// the theory page states them. They share no code with the engine.

/// W_ij, 1/m^2, at distance r.
[[nodiscard]] double smoothing(const MethodN<2>& m, double r);
/// -W'(r)/r, 1/m^4, so that grad_i W_ij = -slope x_ij; finite at r = 0.
[[nodiscard]] double smoothing_slope(const MethodN<2>& m, double r);

/// eq. 9, Pa, one per wall particle.
[[nodiscard]] std::vector<double> plain_wall_pressures(const MethodN<2>& m, const Fluid& fluid,
                                                       const std::vector<Vec2>& walls);

/// Rates per particle, and the largest sum of the sizes of all summands of one particle: what
/// rounding scales with.
struct PlainRates {
  std::vector<Vec2> acceleration;     ///< m/s^2
  std::vector<double> density;        ///< kg/(m^3 s)
  double acceleration_size = 1e-300;  ///< m/s^2
  double density_size = 1e-300;       ///< kg/(m^3 s)
};

/// eqs. 4, 5, 7, 8 the physical viscosity and the wall law with the given wall pressures.
[[nodiscard]] PlainRates plain_rates(const MethodN<2>& m, const Fluid& fluid,
                                     const std::vector<Vec2>& walls,
                                     const std::vector<double>& wall_pressure);

/// eq. 10: rho - rho_0 afterwards, kg/m^3.
[[nodiscard]] std::vector<double> plain_reinitialisation(const MethodN<2>& m, const Fluid& fluid,
                                                         const std::vector<Vec2>& walls,
                                                         const std::vector<double>& wall_pressure);

}  // namespace sluice
