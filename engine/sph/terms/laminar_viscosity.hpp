// Laminar viscosity. Its summand is compiled once per SIMD target.

#ifndef SLUICE_SPH_TERMS_LAMINAR_VISCOSITY
#define SLUICE_SPH_TERMS_LAMINAR_VISCOSITY

#include <optional>
#include <string_view>
#include <tuple>

#include "engine/sph/kernel/discretisation.hpp"
#include "engine/sph/terms/parameter.hpp"
#include "engine/sph/terms/term.hpp"

namespace sluice {

/// Laminar viscous stress with no slip at walls, Morris et al. 1997, eq. 22: sum_j m (mu_i + mu_j)/
/// (rho_i rho_j) x_ij . grad_i W_ij/|x_ij|^2 v_ij, with mu = rho_0 nu and both densities taken as
/// rho_0. Since grad W = -g x_ij/h^4, neither a division nor a singularity is left. Walls take part
/// with v_j = 0. nu is water's, or that of a turbulent flow (eddy viscosity); unlike eq. 8 the
/// stress does not depend on the particle distance.
struct LaminarViscosity {
  double nu = 1e-6;  ///< kinematic viscosity, m^2/s

  static constexpr TermText kText{
      .key = "laminar_viscosity",
      .about = "viscous stress in the fluid, no slip at walls; in place of wall_shear",
      .plan = "viscous stress, nu {nu} m^2/s, no slip at walls",
      .plan_without = "viscous stress, no slip at walls"};
  static constexpr std::tuple kParameters{
      Number{"nu", &LaminarViscosity::nu,
             "kinematic viscosity: 1e-6 m^2/s is water's own, a turbulent flow's is larger",
             from(0, 1e12), "m^2/s"}};
  [[nodiscard]] std::string_view in_report() const { return "nu {nu:g} m^2/s and no slip"; }

  /// 2 nu/(c h): nu in the units of the sums.
  template <int Dim>
  [[nodiscard]] double two_nu(const DiscretisationN<Dim>& d) const {
    return 2.0 * nu / (d.sound_speed * d.smoothing_length);
  }

  static constexpr Summation kSummation{.rate = RateOf::velocity, .holds_at_walls = true};
  template <typename T>
  struct Constants {
    T two_nu{};
  };
  template <typename T, int Dim>
  [[nodiscard]] Constants<T> constants(const DiscretisationN<Dim>& d, Neighbours) const {
    return {static_cast<T>(two_nu(d))};
  }
};

template <>
struct InMethod<LaminarViscosity> {
  std::optional<LaminarViscosity> laminar_viscosity;
};

/// 2 nu/(c h) of a method that may lack the term; then 0.
template <int Dim>
[[nodiscard]] double scaled_two_nu(const std::optional<LaminarViscosity>& term,
                                   const DiscretisationN<Dim>& d) {
  return term ? term->two_nu(d) : 0.0;
}

}  // namespace sluice

#endif

#ifdef SLUICE_SUMMANDS

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

template <>
struct Summand<LaminarViscosity> : NoSummand {
  template <class D, class K, class V, int Dim>
  static HWY_INLINE V add_component(D d, const K& k, V sum, V g, const PairI<V, Dim>&, V velocity_i,
                                    V velocity_j) {
    return hn::NegMulAdd(g, hn::Set(d, k.two_nu) * (velocity_i - velocity_j), sum);
  }
};

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
