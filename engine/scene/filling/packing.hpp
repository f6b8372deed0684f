#pragma once

#include <cstddef>
#include <vector>

#include "engine/space/vec.hpp"

namespace sluice {

/// Points that stay where they are while others are packed beside them.
template <int Dim>
struct FixedPointN {
  VecN<Dim> position = VecN<Dim>::Zero();  ///< m
  double volume = 1.0;                     ///< in dx^d
};

/// How a packing ended.
struct PackingReport {
  std::size_t particles = 0;
  int iterations = 0;
  /// dx abs(grad C), squares summed over all points and divided by the number of those near a fixed
  /// point: what is amiss is amiss there, and an inside however large does not hide it. 0 on a
  /// lattice.
  double residual = 0.0;
};

/// Most iterations of a packing.
inline constexpr int kMaxPackingIterations = 400;

/// Particle packing after Colagrossi, Bouscasse, Antuono and Marrone 2012: points move against the
/// gradient of the concentration C = sum_j V_j W, damped, until it is uniform:
///
///   du/dt = -grad C - zeta u,  dx/dt = u,
///
/// in units in which a long wave of C travels at speed 1. W is the Wendland C2 with h = 1.5 dx,
/// whatever the scene's kernel: no function but the square root is needed, and every machine gives
/// the same bits. Double precision, one thread, O(points) per iteration and at most
/// kMaxPackingIterations of them; no point moves farther than dx/10 in one.
template <int Dim>
[[nodiscard]] PackingReport pack(std::vector<VecN<Dim>>& points,
                                 const std::vector<FixedPointN<Dim>>& fixed, double spacing);

/// Distance beyond which a fixed point does nothing, m.
[[nodiscard]] constexpr double packing_reach(double spacing) { return 3.0 * spacing; }

}  // namespace sluice
