#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "engine/sph/method/method.hpp"
#include "engine/sph/stability/surface_wave_limit.hpp"

namespace sluice {

/// What the sums of eqs. 4, 5, 7 and 8 and the physical viscosity make of a small plane wave exp(i
/// k . x) on a square or cubic lattice at rest, in units of h and c. With velocity U and density
/// s = i sigma the rates are
///   dU/dt = gradient sigma - damping U,  dsigma/dt = -gradient . U - diffusion sigma.
template <int Dim>
struct LatticeWaveN {
  using Tensor = Eigen::Matrix<double, Dim, Dim>;

  VecN<Dim> wave_vector = VecN<Dim>::Zero();  ///< k h
  VecN<Dim> gradient = VecN<Dim>::Zero();     ///< sum_j V_j slope X_ij sin(k . X_ij)
  Tensor damping = Tensor::Zero();            ///< of eq. 8 and physical viscosity
  double diffusion = 0.0;                     ///< of eq. 7
  std::vector<std::complex<double>> rates{};  ///< eigenvalues of the rates, c/h
};

/// Whether waves along a free surface are looked at beside those of the bulk.
enum class Surface { none, free };

/// Von Neumann analysis of the discrete scheme: the amplification matrix of one step for waves of
/// the Brillouin zone, computed from the method's kernel, h/dx, alpha, epsilon, delta and
/// integrator as the engine does them. Eq. 8 acts between particles that approach, which is half of
/// the pairs of a short wave and half of the time for a long one, so it counts half. Left out:
/// walls, gravity, pressure at rest (p << rho_0 c^2), and wall friction. Sources: eqs. 13-17 (they
/// are Adams-Bashforth 2 for velocity and density), Adami et al. 2012.
template <int Dim>
class LatticeStabilityN {
 public:
  LatticeStabilityN(const MethodN<Dim>& method, Surface surface);

  /// The wave of a wave vector k h, its rates only for the paper's integrator, which needs them.
  [[nodiscard]] LatticeWaveN<Dim> wave(const VecN<Dim>& k) const;

  /// Largest modulus of an eigenvalue of one step of length `courant` h/c, over all waves.
  [[nodiscard]] double spectral_radius(double courant) const;
  /// Largest C up to which no wave grows, to 1e-4; 0 where even C = 0.01 lets one grow;
  /// kMostCourant where there is none.
  [[nodiscard]] double courant_limit() const;
  /// The same for what damps velocities alone, eq. 8 and physical viscosity, and for eq. 7 alone.
  [[nodiscard]] double viscosity_limit() const;
  [[nodiscard]] double diffusion_limit() const;

  static constexpr double kMostCourant = 100.0;
  /// A radius up to 1 + this counts as 1: rounding of the eigenvalues.
  static constexpr double kTolerance = 1e-9;

 private:
  using LatticeWave = LatticeWaveN<Dim>;

  [[nodiscard]] double radius(const LatticeWave& wave, double courant) const;
  [[nodiscard]] double radius(const SheetWave& wave, double courant) const;
  /// Lowers `limit` to that of `wave`, if it is lower; true when it was.
  template <class Wave>
  bool lower(const Wave& wave, double& limit) const;

  struct Neighbour {
    VecN<Dim> distance;  ///< X_ij = x_ij/h
    double weight;       ///< V_j slope
  };
  Integrator integrator_;
  double alpha_ = 0.0;
  double epsilon_ = 0.0;
  double delta_ = 0.0;
  double two_nu_ = 0.0;  ///< 2 nu/(c h)
  double spacing_;       ///< dx/h
  std::vector<Neighbour> neighbours_;
  std::vector<LatticeWave> waves_;
  std::vector<SheetWave> sheets_;
};

/// In the plane.
using LatticeStability = LatticeStabilityN<2>;

/// Largest stable Courant numbers: of the scheme, and of parts of it alone.
struct CourantLimits {
  double scheme = 0.0;     ///< all terms of the method
  double sound = 0.0;      ///< pressure waves alone; 0 with the paper's integrator
  double viscosity = 0.0;  ///< eq. 8 and physical viscosity alone; kMostCourant without them
  double diffusion = 0.0;  ///< eq. 7 alone; kMostCourant without it
};
template <int Dim>
[[nodiscard]] CourantLimits courant_limits(const MethodN<Dim>& method, Surface surface);

}  // namespace sluice
