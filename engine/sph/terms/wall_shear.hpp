// Wall shear: the wall law. Its summand is compiled once per SIMD target.

#ifndef SLUICE_SPH_TERMS_WALL_SHEAR
#define SLUICE_SPH_TERMS_WALL_SHEAR

#include <optional>
#include <string_view>
#include <tuple>

#include "engine/space/lattice.hpp"
#include "engine/space/space_traits.hpp"
#include "engine/sph/kernel/discretisation.hpp"
#include "engine/sph/terms/parameter.hpp"
#include "engine/sph/terms/term.hpp"

namespace sluice {

/// The stress that a viscous stress puts on fluid sliding along a wall, over 2 rho_0 nu |v|/h, on a
/// lattice that goes on in the wall: (dx/h)^(d+1) sum n slope(R^2), for in n rows of fluid there is
/// a row of the wall n dx below.
template <int Dim>
[[nodiscard]] double stress_across_wall(const DiscretisationN<Dim>& d) {
  const double dx = d.spacing / d.smoothing_length;
  const int reach = static_cast<int>(d.support_ratio() / dx) + 1;
  CellN<Dim> first = shifted<Dim>({}, -reach);
  first[kUpAxis] = 1;
  double sum = 0.0;
  for_each_cell<Dim>(first, shifted<Dim>({}, reach), [&](const CellN<Dim>& cell) {
    const double r_sq = dx * dx * as_vector<Dim>(cell).squaredNorm();
    if (r_sq >= d.support_ratio() * d.support_ratio()) return;
    sum += static_cast<double>(cell[kUpAxis]) * kernel_slope<Dim>(d.kernel, r_sq);
  });
  return times_power<Dim + 1>(1.0, dx) * sum;
}

/// Wall law: the stress Cf/2 rho_0 |v| v of a turbulent boundary layer too thin to be resolved, on
/// fluid that slides along a wall at rest. It depends on neither the particle distance nor any
/// scale of the flow. It is summed as a viscous stress against the wall's particles, with the
/// nu_i = Cf |v_i| h/(4 S) that makes the sum over wall and fluid that stress; S is
/// stress_across_wall().
struct WallShear {
  double coefficient = 0.01;  ///< skin friction coefficient Cf, dimensionless

  static constexpr TermText kText{
      .key = "wall_shear",
      .about = "stress at walls that grows with the square of the speed",
      .plan = "stress at walls that grows with the square of the speed"};
  static constexpr std::tuple kParameters{
      Number{"coefficient", &WallShear::coefficient,
             "skin friction coefficient: stress at the wall over rho v^2/2; 0.004 is a smooth "
             "wall's, more stands for walls in front and behind as well",
             from(0, 1)}};
  [[nodiscard]] std::string_view in_report() const { return "wall drag Cf {coefficient:g}"; }

  static constexpr Summation kSummation{
      .rate = RateOf::velocity, .over_fluid = false, .holds_at_walls = true};
  template <typename T>
  struct Constants {
    T two_nu_by_speed{};  ///< 2 nu_i/(c h) over |v_i|/c
  };
  template <typename T, int Dim>
  [[nodiscard]] Constants<T> constants(const DiscretisationN<Dim>& d, Neighbours) const {
    return {static_cast<T>(coefficient / (2.0 * stress_across_wall(d)))};
  }
};

template <>
struct InMethod<WallShear> {
  std::optional<WallShear> wall_shear;
};

}  // namespace sluice

#endif

#ifdef SLUICE_SUMMANDS

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

template <>
struct Summand<WallShear> : NoSummand {
  template <class D, class K, class V, int Dim>
  static HWY_INLINE V add_component(D d, const K& k, V sum, V g, const PairI<V, Dim>& i,
                                    V velocity_i, V /*velocity_j*/) {
    return hn::NegMulAdd(g, hn::Set(d, k.two_nu_by_speed) * i.speed * velocity_i, sum);
  }
};

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
