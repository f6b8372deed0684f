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
#include <array>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "engine/sph/loops/pair_loop-inl.hpp"
#include "engine/sph/loops/rate_sums-inl.hpp"
#include "engine/sph/terms/terms-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Adds the pairs of one list to the particles i and, where it is mutual, to the particles j. The
/// sums of i and j stand in the order of their blocks.
template <class Shape, class Rates, class Terms, int Dim, typename T, class V>
HWY_INLINE void add_rates(const PairList::Chunk& list, std::size_t c, const PairView<T, Dim>& other,
                          const OriginShift<T, Dim>& shift, const std::array<V, Dim>& x_i,
                          const Terms& terms, const PairI<V, Dim>& i,
                          std::array<V, Rates::blocks.count>& of_i, T* sums) {
  constexpr const SumBlocks<Dim>& blocks = Rates::blocks;
  const typename Blocks<T>::D d;
  const auto body = [&](std::size_t slot, const std::array<V, Dim>& x_ij, std::size_t n,
                        std::size_t part) HWY_ATTR {
    const PairJ<T, Dim> j{other, slot};
    PairGeometry<V, Dim> pair{x_ij, dot(x_ij, x_ij), hn::Zero(d)};
    const V g = Shape::slope(d, pair.r_sq);
    const auto v_ij =
        array_of<Dim>([&](auto axis) HWY_ATTR { return i.velocity[axis] - j.velocity(axis); });
    pair.approach = dot(v_ij, x_ij);
    std::array<V, blocks.count> of_j;
    if constexpr (Rates::density) {
      const V exchange = terms.add_exchange(hn::Zero(d), i, j);
      const V summand = Continuity::add_to(exchange, pair, i.density);
      const V volume_j = g * j.volume();
      of_i[blocks.density] = hn::MulAdd(volume_j, summand, of_i[blocks.density]);
      if constexpr (Rates::shifting) {
        unroll<Dim>([&](auto axis) HWY_ATTR {
          V& along = of_i[blocks.vector[axis]];
          along = hn::MulAdd(volume_j, ShiftingSummands::component(pair, axis), along);
        });
        V& trace = of_i[blocks.trace];
        trace = hn::MulAdd(volume_j, ShiftingSummands::trace(pair), trace);
      }
      if constexpr (Terms::mutual) {
        const V density = hn::Set(d, T{1}) + j.excess();
        const V volume_i = g * i.volume;
        of_j[blocks.density] = volume_i * Continuity::add_for_j(exchange, pair, density);
        if constexpr (Rates::shifting) {
          unroll<Dim>([&](auto axis) HWY_ATTR {
            of_j[blocks.vector[axis]] = volume_i * ShiftingSummands::component(pair, axis);
          });
          of_j[blocks.trace] = hn::Neg(volume_i * ShiftingSummands::trace(pair));
        }
      }
    }
    if constexpr (Rates::acceleration) {
      V summand = PressureGradient::summand(i.pressure_term, j.pressure_term());
      summand = terms.add_along(summand, pair, i, j) * g;
      unroll<Dim>([&](auto axis) HWY_ATTR {
        const V along =
            terms.add_component(summand * x_ij[axis], g, i, i.velocity[axis], j.velocity(axis));
        of_i[blocks.vector[axis]] = of_i[blocks.vector[axis]] + along;
        of_j[blocks.vector[axis]] = along;
      });
    }
    if constexpr (Terms::mutual) {
      subtract_from_j<blocks.stride>(place_of(sums, blocks.stride, list, n, part), of_j);
    }
  };
  for_each_pair<Dim>(list, c, other, shift, x_i, body);
}

/// eqs. 4 and 5 with the chosen terms for the clusters of a chunk.
template <class Shape, class Rates, typename T, int Dim>
void sum_rates(const SweepTask<T, Dim>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  constexpr const SumBlocks<Dim>& blocks = Rates::blocks;
  const typename Rates::template Terms<Neighbours::fluid, T> in_fluid{task.constants->in_fluid};
  const typename Rates::template Terms<Neighbours::walls, T> at_walls{task.constants->at_walls};
  const OriginShift<T, Dim>& shift = task.constants->origin_shift;
  std::fill_n(task.sums, blocks.stride * task.to_fluid->places(), T{});

  for (std::size_t c = 0; c < task.clusters; ++c) {
    for (std::size_t part = 0; part < kCluster; part += B::i_count) {
      const std::size_t slot = kCluster * (task.first_cluster + c) + part;
      const PairView<T, Dim>& self = task.self;
      const auto x_i = load_i<Dim>(self.position, slot);
      const V excess = load_i(self.excess + slot);
      PairI<V, Dim> i;
      i.velocity = load_i<Dim>(self.velocity, slot);
      i.speed = hn::Sqrt(dot(i.velocity, i.velocity));
      i.density = hn::Set(d, T{1}) + excess;
      i.half = hn::MulAdd(hn::Set(d, T{0.5}), excess, hn::Set(d, T{1}));
      i.volume = load_i(self.volume + slot);
      i.diffused = load_i(self.diffused + slot);
      i.pressure_term = load_i(self.pressure_term + slot);
      auto of_i = array_of<blocks.count>([&](auto) HWY_ATTR { return hn::Zero(d); });

      add_rates<Shape, Rates, decltype(in_fluid), Dim>(*task.to_fluid, c, task.fluid, shift, x_i,
                                                       in_fluid, i, of_i, task.sums);
      if (task.to_wall != nullptr) {
        add_rates<Shape, Rates, decltype(at_walls), Dim>(*task.to_wall, c, task.wall, shift, x_i,
                                                         at_walls, i, of_i, task.sums);
      }
      T* const sums = task.sums + blocks.stride * c + part;
      unroll<blocks.count>([&](auto block)
                               HWY_ATTR { add_lanes(of_i[block], sums + kCluster * block); });
    }
  }
}

/// The loop for the terms of a method: `Rates` with those of the list that it has. What a loop does
/// not sum is not a choice, nor a second term that holds the fluid at walls: each loop is compiled
/// once.
template <class Shape, class Rates, typename T, int Dim>
typename Sweeps<T, Dim>::Sweep select_rates(const MethodN<Dim>&, TermList<>) {
  return &sum_rates<Shape, Rates, T, Dim>;
}
template <class Shape, class Rates, typename T, int Dim, class First, class... Rest>
typename Sweeps<T, Dim>::Sweep select_rates(const MethodN<Dim>& m, TermList<First, Rest...>) {
  constexpr Summation summation = First::kSummation;
  const auto& term = m.template term<First>();
  if constexpr (Rates::template sums<summation.rate>) {
    typename Sweeps<T, Dim>::Sweep found = nullptr;
    const auto try_form = [&]<int kForm>() {
      if (!term || form_of(*term) != kForm) return;
      using With = typename Rates::template With<First, kForm>;
      found = select_rates<Shape, With, T, Dim>(m, beside<First>(TermList<Rest...>{}));
    };
    [&]<int... kForms>(std::integer_sequence<int, kForms...>) {
      (try_form.template operator()<kForms>(), ...);
    }
    (std::make_integer_sequence<int, summation.forms>{});
    if (found != nullptr) return found;
    if (term) throw std::logic_error("a term has more forms than its Summation says");
  }
  return select_rates<Shape, Rates, T, Dim>(m, TermList<Rest...>{});
}
template <class Shape, Sums kSums, typename T, int Dim, bool kShifting = false>
typename Sweeps<T, Dim>::Sweep select_rates(const MethodN<Dim>& m) {
  return select_rates<Shape, RateSums<Dim, kSums, kShifting>, T, Dim>(m, RateTerms{});
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
