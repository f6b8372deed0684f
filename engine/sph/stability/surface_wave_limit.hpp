#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "engine/sph/method/method.hpp"

namespace sluice {

/// The sums of eqs. 4, 5, 7 and 8 for a small wave exp(i k . x) that runs along a sheet, a few
/// layers of particles with a free surface above and below, in units of h and c: with velocities U
/// of all layers and densities s,
///   dU/dt = pressure s - damping U,  ds/dt = divergence U - diffusion s.
/// The particles at a surface lack half of their neighbours, which makes the fastest pressure wave
/// some 7 % faster than any in the bulk, in the plane and in space alike.
struct SheetWave {
  Eigen::MatrixXcd divergence;                ///< layers x d layers
  Eigen::MatrixXcd pressure;                  ///< d layers x layers
  Eigen::MatrixXcd damping;                   ///< d layers x d layers
  Eigen::MatrixXcd diffusion;                 ///< layers x layers
  std::vector<std::complex<double>> rates{};  ///< eigenvalues of all of it, c/h

  /// Largest modulus of an eigenvalue of one kick-drift-kick step of length `courant` h/c.
  [[nodiscard]] double kick_drift_kick_radius(double courant) const;
};

/// Waves of all lengths and directions along the sheet, as far as symmetry makes them differ.
/// `approaching` is the share of pairs that eq. 8 acts between.
template <int Dim>
[[nodiscard]] std::vector<SheetWave> sheet_waves(const MethodN<Dim>& method, double approaching);

}  // namespace sluice
