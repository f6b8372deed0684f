// The sums of eqs. 4 and 5 with the terms of the rates, and of particle shifting. Included once per
// SIMD target.

#if defined(SLUICE_RATES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_RATES_INL
#undef SLUICE_RATES_INL
#else
#define SLUICE_RATES_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/sph/loops/pair_loop-inl.hpp"
#include "engine/sph/loops/rate_sums-inl.hpp"
#include "engine/sph/terms/terms-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sums of the particles i of a vector.
template <class V>
struct SumsOfI {
  V density, x, y, trace;
};

/// Adds the pairs of one list to the particles i and, where it is mutual, to the particles j.
template <class Shape, class Rates, class Terms, typename T, class V>
HWY_INLINE void add_rates(const PairList::Chunk& list, std::size_t c, const PairView<T>& other,
                          const OriginShift<T>& shift, V x_i, V y_i, const Terms& terms,
                          const PairI<V>& i, SumsOfI<V>& of_i, T* sums) {
  const typename Blocks<T>::D d;
  const auto body = [&](std::size_t slot, V dx, V dy, std::size_t n, std::size_t part) HWY_ATTR {
    const PairJ<T> j{other, slot};
    PairGeometry<V> pair{dx, dy, hn::MulAdd(dx, dx, dy * dy), hn::Zero(d)};
    const V g = Shape::slope(d, pair.r_sq);
    pair.approach = hn::MulAdd(i.u - j.u(), dx, (i.v - j.v()) * dy);
    V density_j, x_j, y_j, trace_j;
    if constexpr (Rates::density) {
      const V exchange = terms.add_exchange(hn::Zero(d), i, j);
      const V summand = Continuity::add_to(exchange, pair, i.density);
      const V volume_j = g * j.volume();
      of_i.density = hn::MulAdd(volume_j, summand, of_i.density);
      if constexpr (Rates::shifting) {
        of_i.x = hn::MulAdd(volume_j, ShiftingSummands::x(pair), of_i.x);
        of_i.y = hn::MulAdd(volume_j, ShiftingSummands::y(pair), of_i.y);
        of_i.trace = hn::MulAdd(volume_j, ShiftingSummands::trace(pair), of_i.trace);
      }
      if constexpr (Terms::mutual) {
        const V density = hn::Set(d, T{1}) + j.excess();
        const V volume_i = g * i.volume;
        density_j = volume_i * Continuity::add_for_j(exchange, pair, density);
        if constexpr (Rates::shifting) {
          x_j = volume_i * ShiftingSummands::x(pair);
          y_j = volume_i * ShiftingSummands::y(pair);
          trace_j = hn::Neg(volume_i * ShiftingSummands::trace(pair));
        }
      }
    }
    if constexpr (Rates::acceleration) {
      V summand = PressureGradient::summand(i.pressure_term, j.pressure_term());
      summand = terms.add_along(summand, pair, i, j) * g;
      x_j = terms.add_component(summand * dx, g, i, i.u, j.u());
      y_j = terms.add_component(summand * dy, g, i, i.v, j.v());
      of_i.x = of_i.x + x_j;
      of_i.y = of_i.y + y_j;
    }
    if constexpr (Terms::mutual) {
      T* const to = place_of(sums, Rates::blocks.stride, list, n, part);
      if constexpr (Rates::density && Rates::acceleration) {
        subtract_from_j(to, density_j, y_j, x_j);
      } else if constexpr (Rates::shifting) {
        subtract_from_j(to, density_j, y_j, x_j, trace_j);
      } else if constexpr (Rates::density) {
        subtract_from_j(to, density_j);
      } else {
        subtract_from_j(to, y_j, x_j);
      }
    }
  };
  for_each_pair(list, c, other, shift, x_i, y_i, body);
}

/// eqs. 4 and 5 with the chosen terms for the clusters of a chunk.
template <class Shape, class Rates, typename T>
void sum_rates(const SweepTask<T>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const typename Rates::template Terms<Neighbours::fluid, T> in_fluid{task.constants->in_fluid};
  const typename Rates::template Terms<Neighbours::walls, T> at_walls{task.constants->at_walls};
  const OriginShift<T> shift(task.constants->origin_cell_size);
  std::fill_n(task.sums, Rates::blocks.stride * task.to_fluid->places(), T{});

  for (std::size_t c = 0; c < task.clusters; ++c) {
    for (std::size_t part = 0; part < kCluster; part += B::i_count) {
      const std::size_t slot = kCluster * (task.first_cluster + c) + part;
      const PairView<T>& self = task.self;
      const V x_i = load_i(self.x + slot);
      const V y_i = load_i(self.y + slot);
      const V excess = load_i(self.excess + slot);
      PairI<V> i;
      i.u = load_i(self.u + slot);
      i.v = load_i(self.v + slot);
      i.speed = hn::Sqrt(hn::MulAdd(i.u, i.u, i.v * i.v));
      i.density = hn::Set(d, T{1}) + excess;
      i.half = hn::MulAdd(hn::Set(d, T{0.5}), excess, hn::Set(d, T{1}));
      i.volume = load_i(self.volume + slot);
      i.diffused = load_i(self.diffused + slot);
      i.pressure_term = load_i(self.pressure_term + slot);
      SumsOfI<V> of_i{hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};

      add_rates<Shape, Rates>(*task.to_fluid, c, task.fluid, shift, x_i, y_i, in_fluid, i, of_i,
                              task.sums);
      if (task.to_wall != nullptr) {
        add_rates<Shape, Rates>(*task.to_wall, c, task.wall, shift, x_i, y_i, at_walls, i, of_i,
                                task.sums);
      }
      T* const sums = task.sums + Rates::blocks.stride * c + part;
      if constexpr (Rates::density) add_lanes(of_i.density, sums + Rates::blocks.density);
      if constexpr (Rates::acceleration || Rates::shifting) {
        add_lanes(of_i.x, sums + Rates::blocks.x);
        add_lanes(of_i.y, sums + Rates::blocks.y);
      }
      if constexpr (Rates::shifting) add_lanes(of_i.trace, sums + Rates::blocks.trace);
    }
  }
}

/// The loop for the terms of a method: `Rates` with those of the list that it has. What a loop does
/// not sum is not a choice, nor a second term that holds the fluid at walls: each loop is compiled
/// once.
template <class Shape, class Rates, typename T>
typename Sweeps<T>::Sweep select_rates(const Method&, TermList<>) {
  return &sum_rates<Shape, Rates, T>;
}
template <class Shape, class Rates, typename T, class First, class... Rest>
typename Sweeps<T>::Sweep select_rates(const Method& m, TermList<First, Rest...>) {
  constexpr Summation summation = First::kSummation;
  const auto& term = m.term<First>();
  if constexpr (Rates::template sums<summation.rate>) {
    typename Sweeps<T>::Sweep found = nullptr;
    const auto try_form = [&]<int kForm>() {
      if (!term || form_of(*term) != kForm) return;
      using With = typename Rates::template With<First, kForm>;
      found = select_rates<Shape, With, T>(m, beside<First>(TermList<Rest...>{}));
    };
    [&]<int... kForms>(std::integer_sequence<int, kForms...>) {
      (try_form.template operator()<kForms>(), ...);
    }
    (std::make_integer_sequence<int, summation.forms>{});
    if (found != nullptr) return found;
  }
  return select_rates<Shape, Rates, T>(m, TermList<Rest...>{});
}
template <class Shape, Sums kSums, typename T, bool kShifting = false>
typename Sweeps<T>::Sweep select_rates(const Method& m) {
  return select_rates<Shape, RateSums<kSums, kShifting>, T>(m, RateTerms{});
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
