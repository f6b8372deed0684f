// The terms of the pair sums, one small type each. Included once per SIMD target.
//
// Sums run in dimensionless variables, so that no scale of length, gravity or density can overflow
// single precision:
//   X = x/h   U = v/c   s = (rho - rho_0)/rho_0   V = rho_0/rho   A = p rho_0/(rho c)^2 = s/(1 +
//   s)^2
// A term returns a vector of summands for as many pairs as a vector has lanes. `g` is the slope of
// the kernel.

#if defined(SLUICE_TERMS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_TERMS_INL
#undef SLUICE_TERMS_INL
#else
#define SLUICE_TERMS_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What every term may need of a pair.
template <class V>
struct PairGeometry {
  V dx, dy;    ///< x_ij / h
  V r_sq;      ///< |x_ij|^2 / h^2
  V approach;  ///< v_ij . x_ij / (c h); negative when the two come nearer
};

/// Continuity, eq. 4: D rho_i/Dt = rho_i sum_j (m_j/rho_j) v_ij . grad_i W_ij. Summand before V_j
/// g.
struct Continuity {
  template <class V>
  static HWY_INLINE V add_to(V summand, const PairGeometry<V>& pair, V density_i) {
    return hn::NegMulAdd(density_i, pair.approach, summand);
  }
  /// The same for particle j before -V_i g; `exchange` is what diffuses from j to i.
  template <class V>
  static HWY_INLINE V add_for_j(V exchange, const PairGeometry<V>& pair, V density_j) {
    return hn::MulAdd(density_j, pair.approach, exchange);
  }
};

/// Density diffusion, eq. 7 with the neighbour's volume: 2 delta h c sum_j (psi_j - psi_i) V_j x_ji
/// . grad W_ij/|x_ij|^2. psi is the density (Molteni and Colagrossi 2009), or the density less its
/// hydrostatic part (Fourtakas et al. 2019): for a linear equation of state that part is a field of
/// the particle, so both are this one sum. Since grad W = -g x_ij / h^4, neither the division nor
/// the singularity of the printed form is left.
template <typename T>
struct DensityDiffusionTerm {
  T two_delta;

  template <class D, class V>
  HWY_INLINE V summand(D d, V psi_i, V psi_j) const {
    return hn::Set(d, two_delta) * (psi_j - psi_i);
  }
};

/// Particle shifting (ParticleShifting of method.hpp): -h grad C = sum_j V_j g X_ij, and the trace
/// of the matrix sum_j V_j g X_ij X_ij, 2 inside the fluid and less where neighbours lack. A
/// summand before V_j g; x and y change their sign for particle j, the trace does not.
struct ShiftingTerm {
  template <class V>
  static HWY_INLINE V x(const PairGeometry<V>& pair) {
    return pair.dx;
  }
  template <class V>
  static HWY_INLINE V y(const PairGeometry<V>& pair) {
    return pair.dy;
  }
  template <class V>
  static HWY_INLINE V trace(const PairGeometry<V>& pair) {
    return pair.r_sq;
  }
};

/// Pressure part of the momentum sum, eq. 5: p_i/rho_i^2 + p_j/rho_j^2.
struct PressureGradient {
  template <class V>
  static HWY_INLINE V summand(V pressure_term_i, V pressure_term_j) {
    return pressure_term_i + pressure_term_j;
  }
};

/// Artificial viscosity, eq. 8: Pi_ij = max(-alpha c h/rho_ij v_ij . x_ij/(|x_ij|^2 + epsilon h^2),
/// 0). Between fluid particles it is the paper's stabilising term; against resting wall particles
/// it is a wall friction. Impacts add beta mu_ij^2/rho_ij, with mu_ij the h v_ij . x_ij/(...) of
/// those that approach each other (Monaghan 1992).
template <typename T>
struct ArtificialViscosityTerm {
  T alpha;
  T epsilon;
  T beta;

  /// `half_i` is 1 + s_i/2, so that half_i + s_j/2 is the mean density of the pair.
  template <bool kImpacts, class D, class V>
  HWY_INLINE V add_to(D d, V summand, const PairGeometry<V>& pair, V half_i, V excess_j) const {
    const V mean_density = hn::MulAdd(hn::Set(d, T{0.5}), excess_j, half_i);
    const V divisor = mean_density * (pair.r_sq + hn::Set(d, epsilon));
    const V approach = hn::Min(pair.approach, hn::Zero(d)) / divisor;
    V strength = hn::Set(d, alpha);
    if constexpr (kImpacts) {
      strength = hn::NegMulAdd(hn::Set(d, beta) * mean_density, approach, strength);
    }
    return hn::NegMulAdd(strength, approach, summand);
  }
};

/// Viscous stress, Morris et al. 1997, eq. 22: sum_j m (mu_i + mu_j)/(rho_i rho_j) x_ij . grad_i
/// W_ij/|x_ij|^2 v_ij, with mu = rho_0 nu and both densities taken as rho_0. Since grad W =
/// -g x_ij/h^4, neither a division nor a singularity is left. Walls take part with v_j = 0: no
/// slip.
template <typename T>
struct LaminarViscosityTerm {
  T two_nu;  ///< 2 nu/(c h)

  /// Summand before -g, for one component of the velocity.
  template <class D, class V>
  HWY_INLINE V summand(D d, V velocity_i, V velocity_j) const {
    return hn::Set(d, two_nu) * (velocity_i - velocity_j);
  }
};

/// Wall law: the stress Cf/2 rho_0 |v| v on fluid that slides along a wall at rest, summed as the
/// viscous stress above against the wall's particles, with the nu_i = Cf |v_i| h/(4 S) that makes
/// the sum over wall and fluid that stress; S is stress_across_wall() of term_constants.cpp.
template <typename T>
struct WallShearTerm {
  T two_nu_by_speed;  ///< 2 nu_i/(c h) over |v_i|/c

  /// Summand before -g, for one component of the velocity.
  template <class D, class V>
  HWY_INLINE V summand(D d, V speed_i, V velocity_i) const {
    return hn::Set(d, two_nu_by_speed) * speed_i * velocity_i;
  }
};

/// Wall pressure, eq. 9: (sum_f p_f W + sum_f rho_f f . (x_w - x_f) W) / sum_f W. Summand before W,
/// in units of rho_0 c^2.
template <typename T>
struct WallPressureTerm {
  T gravity_x;  ///< f h/c^2
  T gravity_y;

  template <class D, class V>
  HWY_INLINE V summand(D d, V dx, V dy, V excess_f) const {
    const V head = hn::MulAdd(hn::Set(d, gravity_x), dx, hn::Set(d, gravity_y) * dy);
    return hn::MulAdd(hn::Set(d, T{1}) + excess_f, head, excess_f);
  }
};

/// Reinitialisation, eq. 10: rho_i = sum_j m_j W / sum_j (m_j/rho_j) W. With equal masses the
/// excess of that quotient over rho_0 is sum s_j V_j W / sum V_j W, which keeps the digits.
/// Summands before W.
struct ShepardTerm {
  template <class V>
  static HWY_INLINE V numerator(V excess_j, V volume_j) {
    return excess_j * volume_j;
  }
};

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
