// Artificial viscosity: between fluid particles, and against walls. The summands are compiled once
// per SIMD target.

#ifndef SLUICE_SPH_TERMS_ARTIFICIAL_VISCOSITY
#define SLUICE_SPH_TERMS_ARTIFICIAL_VISCOSITY

#include <optional>
#include <string_view>
#include <tuple>

#include "engine/sph/kernel/discretisation.hpp"
#include "engine/sph/terms/parameter.hpp"
#include "engine/sph/terms/term.hpp"

namespace sluice {

inline constexpr std::string_view kAboutAlpha = "strength alpha of eq. 8";
inline constexpr Range kAlphaRange = from(0, 10);
inline constexpr std::string_view kAboutEpsilon =
    "keeps the denominator of eq. 8 from zero: epsilon h^2";
inline constexpr Range kEpsilonRange = above(0, 1);

/// Pi_ij of eq. 8 between fluid particles, the paper's stabilising term: max(-alpha c h/rho_ij
/// v_ij . x_ij/(|x_ij|^2 + epsilon h^2), 0). Impacts add beta mu_ij^2/rho_ij, with mu_ij the
/// h v_ij . x_ij/(...) of those that approach each other (Monaghan 1992), which keeps particles
/// that collide from running into each other. All dimensionless.
struct ArtificialViscosity {
  double alpha = 0.02;
  double epsilon = 0.01;
  double beta = 0.0;  ///< 0: the quadratic part is left out

  static constexpr TermText kText{
      .key = "artificial_viscosity",
      .about = "artificial viscosity Pi_ij between fluid particles, eq. 8",
      .plan = "eq. 8 between fluid particles"};
  static constexpr std::tuple kParameters{
      Number{"alpha", &ArtificialViscosity::alpha, kAboutAlpha, kAlphaRange},
      Number{"epsilon", &ArtificialViscosity::epsilon, kAboutEpsilon, kEpsilonRange},
      Number{"beta", &ArtificialViscosity::beta,
             "strength of the quadratic part, which acts where particles collide and keeps them "
             "apart at impacts; 0 leaves it out",
             from(0, 10)}};
  [[nodiscard]] std::string_view in_report() const {
    return beta > 0.0 ? "viscosity alpha {alpha:g}, beta {beta:g}" : "viscosity alpha {alpha:g}";
  }

  static constexpr Summation kSummation{.rate = RateOf::velocity, .over_walls = false, .forms = 2};
  [[nodiscard]] int form() const { return beta > 0.0 ? 1 : 0; }
  template <typename T>
  struct Constants {
    T alpha{}, epsilon{}, beta{};
  };
  template <typename T, int Dim>
  [[nodiscard]] Constants<T> constants(const DiscretisationN<Dim>&, Neighbours) const {
    return {static_cast<T>(alpha), static_cast<T>(epsilon), static_cast<T>(beta)};
  }
};

/// Pi_ij of eq. 8 summed against resting walls: a friction that the paper's free slip leaves out.
struct WallArtificialViscosity {
  double alpha = 0.02;
  double epsilon = 0.01;

  static constexpr TermText kText{
      .key = "wall_artificial_viscosity",
      .about =
          "Pi_ij of eq. 8 against walls at rest; not beside laminar_viscosity; in place of "
          "wall_shear",
      .plan = "viscosity of eq. 8 against walls"};
  static constexpr std::tuple kParameters{
      Number{"alpha", &WallArtificialViscosity::alpha, kAboutAlpha, kAlphaRange},
      Number{"epsilon", &WallArtificialViscosity::epsilon, kAboutEpsilon, kEpsilonRange}};
  [[nodiscard]] std::string_view in_report() const { return "wall friction alpha {alpha:g}"; }

  static constexpr Summation kSummation{
      .rate = RateOf::velocity, .over_fluid = false, .holds_at_walls = true};
  template <typename T>
  struct Constants {
    T alpha{}, epsilon{};
  };
  template <typename T, int Dim>
  [[nodiscard]] Constants<T> constants(const DiscretisationN<Dim>&, Neighbours) const {
    return {static_cast<T>(alpha), static_cast<T>(epsilon)};
  }
};

template <>
struct InMethod<ArtificialViscosity> {
  std::optional<ArtificialViscosity> viscosity;
};
template <>
struct InMethod<WallArtificialViscosity> {
  std::optional<WallArtificialViscosity> wall_artificial_viscosity;
};

}  // namespace sluice

#endif

#ifdef SLUICE_SUMMANDS

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

/// Of both: form 1 has the quadratic part.
template <int kForm>
struct Summand<ArtificialViscosity, kForm> : NoSummand {
  template <class D, class K, class V, int Dim, class J>
  static HWY_INLINE V add_along(D d, const K& k, V sum, const PairGeometry<V, Dim>& pair,
                                const PairI<V, Dim>& i, const J& j) {
    const V mean_density = hn::MulAdd(hn::Set(d, hn::TFromD<D>(0.5)), j.excess(), i.half);
    const V divisor = mean_density * (pair.r_sq + hn::Set(d, k.epsilon));
    const V approach = hn::Min(pair.approach, hn::Zero(d)) / divisor;
    V strength = hn::Set(d, k.alpha);
    if constexpr (kForm == 1) {
      strength = hn::NegMulAdd(hn::Set(d, k.beta) * mean_density, approach, strength);
    }
    return hn::NegMulAdd(strength, approach, sum);
  }
};
template <>
struct Summand<WallArtificialViscosity> : Summand<ArtificialViscosity, 0> {};

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
