// The summands of the pair sums. Included once per SIMD target.
//
// Sums run in dimensionless variables, so that no scale of length, gravity or density can overflow
// single precision:
//   X = x/h   U = v/c   s = (rho - rho_0)/rho_0   V = rho_0/rho   A = p rho_0/(rho c)^2 = s/(1 +
//   s)^2
// A summand is a pure function of one pair, for as many pairs as a vector has lanes. `g` is the
// slope of the kernel.

#if defined(SLUICE_TERMS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_TERMS_INL
#undef SLUICE_TERMS_INL
#else
#define SLUICE_TERMS_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>

#include "engine/space/dot-inl.hpp"
#include "engine/space/unroll-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What every term may need of a pair.
template <class V, int Dim>
struct PairGeometry {
  std::array<V, Dim> x_ij;  ///< x_ij / h
  V r_sq;                   ///< |x_ij|^2 / h^2
  V approach;               ///< v_ij . x_ij / (c h); negative when the two come nearer
};

/// What a term may need of the particles i of a vector.
template <class V, int Dim>
struct PairI {
  std::array<V, Dim> velocity;  ///< U
  V speed;                      ///< |U|
  V density;                    ///< 1 + s
  V half;                       ///< 1 + s/2, so that half_i + s_j/2 is the mean density of the pair
  V volume;                     ///< V
  V diffused;                   ///< psi of the density diffusion
  V pressure_term;              ///< A
};

/// What a term adds to the sums: nothing. The summand of a term is derived from it and replaces
/// what the term adds to. `k` are its constants. `j` has what PairI has of the particles j, read
/// when asked: velocity(axis), excess() (s), volume(), diffused(), pressure_term().
struct NoSummand {
  /// Adds to what diffuses from j to i, before V_j g and antisymmetric.
  template <class D, class K, class V, int Dim, class J>
  static HWY_INLINE V add_exchange(D, const K&, V sum, const PairI<V, Dim>&, const J&) {
    return sum;
  }
  /// Adds to the symmetric factor of the acceleration along x_ij, before X_ij g.
  template <class D, class K, class V, int Dim, class J>
  static HWY_INLINE V add_along(D, const K&, V sum, const PairGeometry<V, Dim>&,
                                const PairI<V, Dim>&, const J&) {
    return sum;
  }
  /// Adds to one component of the acceleration, in any direction, g included.
  template <class D, class K, class V, int Dim>
  static HWY_INLINE V add_component(D, const K&, V sum, V /*g*/, const PairI<V, Dim>&,
                                    V /*velocity_i*/, V /*velocity_j*/) {
    return sum;
  }
};

/// The summand of a term of the rates, in the form that Term::form() picks.
template <class Term, int kForm = 0>
struct Summand;

/// Continuity, eq. 4: D rho_i/Dt = rho_i sum_j (m_j/rho_j) v_ij . grad_i W_ij. Summand before V_j
/// g.
struct Continuity {
  template <class V, int Dim>
  static HWY_INLINE V add_to(V summand, const PairGeometry<V, Dim>& pair, V density_i) {
    return hn::NegMulAdd(density_i, pair.approach, summand);
  }
  /// The same for particle j before -V_i g; `exchange` is what diffuses from j to i.
  template <class V, int Dim>
  static HWY_INLINE V add_for_j(V exchange, const PairGeometry<V, Dim>& pair, V density_j) {
    return hn::MulAdd(density_j, pair.approach, exchange);
  }
};

/// Pressure part of the momentum sum, eq. 5: p_i/rho_i^2 + p_j/rho_j^2.
struct PressureGradient {
  template <class V>
  static HWY_INLINE V summand(V pressure_term_i, V pressure_term_j) {
    return pressure_term_i + pressure_term_j;
  }
};

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#define SLUICE_SUMMANDS
#include "engine/sph/terms/list.hpp"
#include "engine/sph/terms/wall_pressure.hpp"
#undef SLUICE_SUMMANDS

#endif  // per-target include guard
