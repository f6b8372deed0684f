// The sums of eqs. 4, 5, 7 and 8, the viscous stress, the wall law and particle shifting. Included
// once per SIMD target.

#if defined(SLUICE_RATES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_RATES_INL
#undef SLUICE_RATES_INL
#else
#define SLUICE_RATES_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "engine/sph/loops/pair_loop-inl.hpp"
#include "engine/sph/terms/terms-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What holds the fluid back at walls: nothing, eq. 8, a stress that acts in the fluid as well, or
/// a wall law.
enum class Viscosity { none, linear, with_impacts };
enum class Drag { none, wall_artificial_viscosity, laminar_viscosity, wall_shear };

/// Which terms a rate sweep sums.
enum class Sums { density, acceleration, both };
template <Sums kSums, bool kDiffusion, Viscosity kViscosity, Drag kDrag, bool kShifting = false>
struct Terms {
  static_assert(!kShifting || kSums == Sums::density);
  static constexpr bool density = kSums != Sums::acceleration;
  static constexpr bool acceleration = kSums != Sums::density;
  static constexpr bool diffusion = density && kDiffusion;
  static constexpr Viscosity viscosity = acceleration ? kViscosity : Viscosity::none;
  static constexpr Viscosity friction = acceleration && kDrag == Drag::wall_artificial_viscosity
                                            ? Viscosity::linear
                                            : Viscosity::none;
  static constexpr bool laminar = acceleration && kDrag == Drag::laminar_viscosity;
  static constexpr bool wall_shear = acceleration && kDrag == Drag::wall_shear;
  static constexpr bool shifting = kShifting;
  static constexpr SumBlocks blocks = shifting        ? kDensityAndShiftingSums
                                      : !acceleration ? kDensitySums
                                      : !density      ? kAccelerationSums
                                                      : kRateSums;
};

/// What the rate sums need of the particles i of a vector, and the sums.
template <class V>
struct RateOfI {
  V u, v, speed, density, half, volume, diffused, pressure_term;
  V density_sum, x_sum, y_sum, trace_sum;
};

/// The terms that a rate sums against one list.
template <typename T>
struct RateTerms {
  ArtificialViscosityTerm<T> viscosity;
  LaminarViscosityTerm<T> laminar;
  WallShearTerm<T> wall_shear;
  DensityDiffusionTerm<T> diffusion;
};

/// Adds the pairs of one list to the particles i and, where `sums` is given, to the particles j.
template <class Shape, class Terms, Viscosity kViscosity, Share kShare, typename T, class V>
HWY_INLINE void add_rates(const PairList::Chunk& list, std::size_t c, const PairView<T>& other,
                          const OriginShift<T>& shift, V x_i, V y_i, const RateTerms<T>& terms,
                          RateOfI<V>& i, T* sums) {
  const typename Blocks<T>::D d;
  const auto body = [&](std::size_t j, V dx, V dy, std::size_t n, std::size_t part) HWY_ATTR {
    PairGeometry<V> pair{dx, dy, hn::MulAdd(dx, dx, dy * dy), hn::Zero(d)};
    const V g = Shape::slope(d, pair.r_sq);
    if constexpr (Terms::density || kViscosity != Viscosity::none) {
      pair.approach = hn::MulAdd(i.u - load_j(other.u + j), dx, (i.v - load_j(other.v + j)) * dy);
    }
    V density_j, x_j, y_j, trace_j;
    if constexpr (Terms::density) {
      V exchange = hn::Zero(d);
      if constexpr (Terms::diffusion) {
        exchange = terms.diffusion.summand(d, i.diffused, load_j(other.diffused + j));
      }
      const V summand = Continuity::add_to(exchange, pair, i.density);
      const V volume_j = g * load_j(other.volume + j);
      i.density_sum = hn::MulAdd(volume_j, summand, i.density_sum);
      if constexpr (Terms::shifting) {
        i.x_sum = hn::MulAdd(volume_j, ShiftingTerm::x(pair), i.x_sum);
        i.y_sum = hn::MulAdd(volume_j, ShiftingTerm::y(pair), i.y_sum);
        i.trace_sum = hn::MulAdd(volume_j, ShiftingTerm::trace(pair), i.trace_sum);
      }
      if constexpr (kShare == Share::both) {
        const V density = hn::Set(d, T{1}) + load_j(other.excess + j);
        const V volume_i = g * i.volume;
        density_j = volume_i * Continuity::add_for_j(exchange, pair, density);
        if constexpr (Terms::shifting) {
          x_j = volume_i * ShiftingTerm::x(pair);
          y_j = volume_i * ShiftingTerm::y(pair);
          trace_j = hn::Neg(volume_i * ShiftingTerm::trace(pair));
        }
      }
    }
    if constexpr (Terms::acceleration) {
      V summand = PressureGradient::summand(i.pressure_term, load_j(other.pressure_term + j));
      if constexpr (kViscosity != Viscosity::none) {
        constexpr bool kImpacts = kViscosity == Viscosity::with_impacts;
        summand = terms.viscosity.template add_to<kImpacts>(d, summand, pair, i.half,
                                                            load_j(other.excess + j));
      }
      summand = summand * g;
      x_j = summand * dx;
      y_j = summand * dy;
      if constexpr (Terms::laminar) {
        x_j = hn::NegMulAdd(g, terms.laminar.summand(d, i.u, load_j(other.u + j)), x_j);
        y_j = hn::NegMulAdd(g, terms.laminar.summand(d, i.v, load_j(other.v + j)), y_j);
      }
      if constexpr (Terms::wall_shear && kShare == Share::i_alone) {
        x_j = hn::NegMulAdd(g, terms.wall_shear.summand(d, i.speed, i.u), x_j);
        y_j = hn::NegMulAdd(g, terms.wall_shear.summand(d, i.speed, i.v), y_j);
      }
      i.x_sum = i.x_sum + x_j;
      i.y_sum = i.y_sum + y_j;
    }
    if constexpr (kShare == Share::both) {
      T* const to = place_of(sums, Terms::blocks.stride, list, n, part);
      if constexpr (Terms::density && Terms::acceleration) {
        subtract_from_j(to, density_j, y_j, x_j);
      } else if constexpr (Terms::shifting) {
        subtract_from_j(to, density_j, y_j, x_j, trace_j);
      } else if constexpr (Terms::density) {
        subtract_from_j(to, density_j);
      } else {
        subtract_from_j(to, y_j, x_j);
      }
    }
  };
  for_each_pair(list, c, other, shift, x_i, y_i, body);
}

/// eqs. 4, 5, 7, 8, the viscous stress and the wall law for the clusters of a chunk.
template <class Shape, class Terms, typename T>
void sum_rates(const SweepTask<T>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const TermConstants<T>& k = *task.constants;
  const OriginShift<T> shift(k.origin_cell_size);
  const RateTerms<T> in_fluid{
      .viscosity = {k.viscosity_alpha, k.viscosity_epsilon, k.viscosity_beta},
      .laminar = {k.two_nu},
      .wall_shear = {k.wall_two_nu_by_speed},
      .diffusion = {k.two_delta}};
  const RateTerms<T> at_walls{.viscosity = {k.friction_alpha, k.friction_epsilon, T{0}},
                              .laminar = {k.two_nu},
                              .wall_shear = {k.wall_two_nu_by_speed},
                              .diffusion = {k.two_delta_wall}};
  std::fill_n(task.sums, Terms::blocks.stride * task.to_fluid->places(), T{});

  for (std::size_t c = 0; c < task.clusters; ++c) {
    for (std::size_t part = 0; part < kCluster; part += B::i_count) {
      const std::size_t slot = kCluster * (task.first_cluster + c) + part;
      const PairView<T>& self = task.self;
      const V x_i = load_i(self.x + slot);
      const V y_i = load_i(self.y + slot);
      RateOfI<V> i;
      i.u = load_i(self.u + slot);
      i.v = load_i(self.v + slot);
      const V excess = load_i(self.excess + slot);
      i.density = hn::Set(d, T{1}) + excess;
      i.half = hn::MulAdd(hn::Set(d, T{0.5}), excess, hn::Set(d, T{1}));
      if constexpr (Terms::density) i.volume = load_i(self.volume + slot);
      if constexpr (Terms::diffusion) i.diffused = load_i(self.diffused + slot);
      if constexpr (Terms::acceleration) i.pressure_term = load_i(self.pressure_term + slot);
      if constexpr (Terms::wall_shear) i.speed = hn::Sqrt(hn::MulAdd(i.u, i.u, i.v * i.v));
      i.density_sum = i.x_sum = i.y_sum = i.trace_sum = hn::Zero(d);

      add_rates<Shape, Terms, Terms::viscosity, Share::both>(*task.to_fluid, c, task.fluid, shift,
                                                             x_i, y_i, in_fluid, i, task.sums);
      if (task.to_wall != nullptr) {
        add_rates<Shape, Terms, Terms::friction, Share::i_alone>(*task.to_wall, c, task.wall, shift,
                                                                 x_i, y_i, at_walls, i, task.sums);
      }
      T* const sums = task.sums + Terms::blocks.stride * c + part;
      if constexpr (Terms::density) add_lanes(i.density_sum, sums + Terms::blocks.density);
      if constexpr (Terms::acceleration || Terms::shifting) {
        add_lanes(i.x_sum, sums + Terms::blocks.x);
        add_lanes(i.y_sum, sums + Terms::blocks.y);
      }
      if constexpr (Terms::shifting) add_lanes(i.trace_sum, sums + Terms::blocks.trace);
    }
  }
}

/// The loop for the terms of a method.
template <class Shape, Sums kSums, typename T, bool kShifting = false>
typename Sweeps<T>::Sweep select_rates(const Method& m) {
  using enum Viscosity;
  const auto with = [&]<bool kDiffusion, Viscosity kViscosity>() -> typename Sweeps<T>::Sweep {
    if (m.wall_artificial_viscosity) {
      return &sum_rates<Shape,
                        Terms<kSums, kDiffusion, kViscosity, Drag::wall_artificial_viscosity>, T>;
    }
    if (m.wall_shear) {
      return &sum_rates<Shape, Terms<kSums, kDiffusion, kViscosity, Drag::wall_shear>, T>;
    }
    return m.laminar_viscosity
               ? &sum_rates<Shape, Terms<kSums, kDiffusion, kViscosity, Drag::laminar_viscosity>, T>
               : &sum_rates<Shape, Terms<kSums, kDiffusion, kViscosity, Drag::none>, T>;
  };
  const auto with_viscosity = [&]<bool kDiffusion>() {
    if (!m.viscosity) return with.template operator()<kDiffusion, none>();
    return m.viscosity->beta > 0.0 ? with.template operator()<kDiffusion, with_impacts>()
                                   : with.template operator()<kDiffusion, linear>();
  };
  // What a sweep does not sum is not a choice: the same loop serves both, and is compiled once.
  if constexpr (kSums == Sums::density) {
    return m.diffusion ? &sum_rates<Shape, Terms<kSums, true, none, Drag::none, kShifting>, T>
                       : &sum_rates<Shape, Terms<kSums, false, none, Drag::none, kShifting>, T>;
  } else if constexpr (kSums == Sums::acceleration) {
    return with_viscosity.template operator()<false>();
  } else {
    return m.diffusion ? with_viscosity.template operator()<true>()
                       : with_viscosity.template operator()<false>();
  }
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
