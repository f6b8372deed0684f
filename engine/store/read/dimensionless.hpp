#pragma once

#include <string_view>

#include "engine/scene/model/scene.hpp"
#include "engine/store/files/series.hpp"

namespace sluice {

/// Divisors that make a series dimensionless.
struct Divisors {
  double time = 1.0;   ///< s: sqrt(h0/|g|), eq. 19
  double value = 1.0;  ///< in the unit of the values
  std::string_view symbol;
};

/// Eqs. 19-22 for a series of `scene`: X = w/w0, H = h/h0, P = p/(rho_0 |g| h0), T = t sqrt(|g|/h0)
/// for arrivals. Energies are divided by rho_0 |g| h0^2 w0 (J/m), which the paper does not define:
/// the column's potential energy at the start is then 1/2. Throws std::invalid_argument when the
/// scene has no scales or no gravity.
[[nodiscard]] Divisors dimensionless_divisors(const Scene& scene, const Series& series);

/// The series divided by them; `duration` too. Its units are "1".
[[nodiscard]] Series dimensionless(Series series, const Divisors& divisors);

}  // namespace sluice
