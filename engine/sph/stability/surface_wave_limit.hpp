#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "engine/sph/method/method.hpp"

namespace sluice {

/// The sums of eqs. 4, 5, 7 and 8 for a small wave exp(i k x) that runs along a sheet of the
/// plane, a few rows of particles with a free surface above and below, in units of h and c: with
/// velocities U of all rows and densities s,
///   dU/dt = pressure s - damping U,  ds/dt = divergence U - diffusion s.
/// The particles at a surface lack half of their neighbours, which makes the fastest pressure wave
/// some 7 % faster than any in the bulk.
struct SheetWave {
  Eigen::MatrixXcd divergence;                ///< rows x 2 rows
  Eigen::MatrixXcd pressure;                  ///< 2 rows x rows
  Eigen::MatrixXcd damping;                   ///< 2 rows x 2 rows
  Eigen::MatrixXcd diffusion;                 ///< rows x rows
  std::vector<std::complex<double>> rates{};  ///< eigenvalues of all of it, c/h

  /// Largest modulus of an eigenvalue of one kick-drift-kick step of length `courant` h/c.
  [[nodiscard]] double kick_drift_kick_radius(double courant) const;
};

/// Waves of all lengths along the sheet. `approaching` is the share of pairs that eq. 8 acts
/// between.
[[nodiscard]] std::vector<SheetWave> sheet_waves(const Method& method, double approaching);

}  // namespace sluice
