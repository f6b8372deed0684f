// Particle shifting. Its summands are compiled once per SIMD target.

#ifndef SLUICE_SPH_TERMS_PARTICLE_SHIFTING
#define SLUICE_SPH_TERMS_PARTICLE_SHIFTING

#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>

#include "engine/space/space_traits.hpp"
#include "engine/sph/terms/parameter.hpp"
#include "engine/sph/terms/term.hpp"

namespace sluice {

/// Particle shifting (Lind et al. 2012, as Skillen et al. 2013 scale it with the speed): a particle
/// inside the fluid moves by -A h |v| dt grad C, C the concentration of particles, so that no
/// gaps open along streamlines. One at a free surface stays.
///
/// It corrects the state: its sums are taken with those of eq. 4, and `loops/steps-inl.hpp` moves
/// the particles.
struct ParticleShifting {
  double coefficient = 2.0;  ///< A, dimensionless

  /// Particles are shifted in every so many steps, for the dt of all: gaps open slowly.
  static constexpr std::uint64_t kInterval = 2;

  /// By how much: not at all where the trace of the matrix sum_j V_j slope X_ij X_ij, d inside the
  /// fluid, is at most kSurfaceTrace, in full from kInsideTrace on.
  ///
  /// A flat surface at the distance x takes d T + x w(x) of it, w the integral of the kernel over a
  /// plane parallel to the surface and T that of w beyond x. At the second row T is small, and what
  /// the row lacks is not in proportion to d: with Wendland C2 and h = 1.5 dx 0.18 in the plane and
  /// 0.17 in space. The first row lacks 0.76 and 1.00, the third 0.01 and 0.
  template <int Dim>
  static constexpr double kSurfaceTrace = SpaceTraits<Dim>::trace_inside - 0.25;
  template <int Dim>
  static constexpr double kInsideTrace = SpaceTraits<Dim>::trace_inside - 0.1;

  static constexpr TermText kText{
      .key = "particle_shifting",
      .about = "moves particles inside the fluid to where others lack; with kick_drift_kick",
      .plan = "towards where particles lack, A {coefficient}, in the sweep of eq. 4",
      .plan_without = "towards where particles lack"};
  static constexpr std::tuple kParameters{
      Number{"coefficient", &ParticleShifting::coefficient,
             "A: a particle moves by A h |v| dt grad C against the gradient of the concentration "
             "C, at most 0.1 particle distances in a step",
             above(0, 10)}};
  [[nodiscard]] std::string_view in_report() const { return "shifting A {coefficient:g}"; }
};

template <>
struct InMethod<ParticleShifting> {
  std::optional<ParticleShifting> shifting;
};

}  // namespace sluice

#endif

#ifdef SLUICE_SUMMANDS

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

/// -h grad C = sum_j V_j g X_ij, and the trace of the matrix sum_j V_j g X_ij X_ij, which is
/// SpaceTraits::trace_inside inside the fluid and less where neighbours lack. Summands before V_j
/// g; components change their sign for particle j, the trace does not.
struct ShiftingSummands {
  template <class V, int Dim>
  static HWY_INLINE V component(const PairGeometry<V, Dim>& pair, std::size_t axis) {
    return pair.x_ij[axis];
  }
  template <class V, int Dim>
  static HWY_INLINE V trace(const PairGeometry<V, Dim>& pair) {
    return pair.r_sq;
  }
};

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
