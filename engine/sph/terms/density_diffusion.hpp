// Density diffusion. Its summand is compiled once per SIMD target.

#ifndef SLUICE_SPH_TERMS_DENSITY_DIFFUSION
#define SLUICE_SPH_TERMS_DENSITY_DIFFUSION

#include <optional>
#include <string_view>
#include <tuple>

#include "engine/sph/kernel/discretisation.hpp"
#include "engine/sph/terms/parameter.hpp"
#include "engine/sph/terms/term.hpp"

namespace sluice {

/// What is diffused by the density diffusion term D_i.
enum class DiffusionKind {
  molteni_colagrossi,  ///< eq. 7: the density
  fourtakas,           ///< the density less its hydrostatic part
};
inline constexpr Words<DiffusionKind, 2> kDiffusionWords{{
    {"molteni_colagrossi", DiffusionKind::molteni_colagrossi, "of the density"},
    {"fourtakas", DiffusionKind::fourtakas,
     "of the density less its hydrostatic part, between fluid particles"},
}};

/// D_i of eq. 7 with the neighbour's volume: 2 delta h c sum_j (psi_j - psi_i) V_j x_ji .
/// grad W_ij/|x_ij|^2. psi is the density (Molteni and Colagrossi 2009), or the density less its
/// hydrostatic part (Fourtakas et al. 2019): for a linear equation of state that part is a field of
/// the particle, so both are this one sum. Since grad W = -g x_ij / h^4, neither the division nor
/// the singularity of the printed form is left.
struct DensityDiffusion {
  DiffusionKind kind = DiffusionKind::molteni_colagrossi;
  double delta = 0.1;  ///< dimensionless

  static constexpr TermText kText{.key = "density_diffusion",
                                  .about = "density diffusion D_i, eq. 7",
                                  .plan = "eq. 7, {kind}, delta {delta}",
                                  .plan_without = "eq. 7"};
  static constexpr std::tuple kParameters{
      Choice{"kind", &DensityDiffusion::kind, "what is diffused", kDiffusionWords},
      Number{"delta", &DensityDiffusion::delta, "strength delta of eq. 7", from(0, 2)}};
  [[nodiscard]] std::string_view in_report() const { return "diffusion {kind} delta {delta:g}"; }

  /// Whether psi is a field of its own: Molteni and Colagrossi diffuse the excess itself.
  [[nodiscard]] bool keeps_field() const { return kind == DiffusionKind::fourtakas; }

  static constexpr Summation kSummation{.rate = RateOf::density};
  template <typename T>
  struct Constants {
    T two_delta{};
  };
  /// The density of a wall follows from eq. 9 and is not kept: an exchange with it is a source,
  /// which lifts still water for ever. Only where the hydrostatic part is diffused as well must the
  /// walls hold against it.
  template <typename T, int Dim>
  [[nodiscard]] Constants<T> constants(const DiscretisationN<Dim>&, Neighbours j) const {
    const bool diffuses = j == Neighbours::fluid || kind == DiffusionKind::molteni_colagrossi;
    return {diffuses ? static_cast<T>(2.0 * delta) : T{0}};
  }
};

template <>
struct InMethod<DensityDiffusion> {
  std::optional<DensityDiffusion> diffusion;
};

}  // namespace sluice

#endif

#ifdef SLUICE_SUMMANDS

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

template <>
struct Summand<DensityDiffusion> : NoSummand {
  template <class D, class K, class V, int Dim, class J>
  static HWY_INLINE V add_exchange(D d, const K& k, V sum, const PairI<V, Dim>& i, const J& j) {
    return hn::MulAdd(hn::Set(d, k.two_delta), j.diffused() - i.diffused, sum);
  }
};

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
