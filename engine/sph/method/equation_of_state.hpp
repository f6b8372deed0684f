#pragma once

namespace sluice {

/// Linear equation of state, eq. 3: p = c^2 (rho - rho_0). The density is carried as its excess rho
/// - rho_0, which keeps the digits that a weakly compressible fluid lives on. p may be negative.
struct LinearEquationOfState {
  double sound_speed = 0.0;  ///< c, m/s

  /// Pa from kg/m^3.
  [[nodiscard]] constexpr double pressure(double density_excess) const {
    return sound_speed * sound_speed * density_excess;
  }
  /// kg/m^3 from Pa.
  [[nodiscard]] constexpr double density_excess(double pressure) const {
    return pressure / (sound_speed * sound_speed);
  }
};

}  // namespace sluice
