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

/// Adds a vector of pairs to its particles i; `of_j` is what the particles j of a mutual list lose.
template <class Shape, class Rates, int Dim, class Terms, class V, class J>
HWY_INLINE void add_pairs(const Terms& terms, const PairI<V, Dim>& i, const J& j,
                          const std::array<V, Dim>& x_ij, std::array<V, Rates::blocks.count>& of_i,
                          std::array<V, Rates::blocks.count>& of_j) {
  constexpr const SumBlocks<Dim>& blocks = Rates::blocks;
  const hn::DFromV<V> d;
  using T = hn::TFromV<V>;
  PairGeometry<V, Dim> pair{x_ij, dot(x_ij, x_ij), hn::Zero(d)};
  const V g = Shape::slope(d, pair.r_sq);
  const auto v_ij =
      array_of<Dim>([&](auto axis) SLUICE_ATTR { return i.velocity[axis] - j.velocity(axis); });
  pair.approach = dot(v_ij, x_ij);
  if constexpr (Rates::density) {
    const V exchange = terms.add_exchange(hn::Zero(d), i, j);
    const V summand = Continuity::add_to(exchange, pair, i.density);
    const V volume_j = g * j.volume();
    of_i[blocks.density] = hn::MulAdd(volume_j, summand, of_i[blocks.density]);
    if constexpr (Rates::shifting) {
      unroll<Dim>([&](auto axis) SLUICE_ATTR {
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
        unroll<Dim>([&](auto axis) SLUICE_ATTR {
          of_j[blocks.vector[axis]] = volume_i * ShiftingSummands::component(pair, axis);
        });
        of_j[blocks.trace] = hn::Neg(volume_i * ShiftingSummands::trace(pair));
      }
    }
  }
  if constexpr (Rates::acceleration) {
    V summand = PressureGradient::summand(i.pressure_term, j.pressure_term());
    summand = terms.add_along(summand, pair, i, j) * g;
    unroll<Dim>([&](auto axis) SLUICE_ATTR {
      const V along =
          terms.add_component(summand * x_ij[axis], g, i, i.velocity[axis], j.velocity(axis));
      of_i[blocks.vector[axis]] = of_i[blocks.vector[axis]] + along;
      of_j[blocks.vector[axis]] = along;
    });
  }
}

/// Adds the pairs of one list to the particles i and, where it is mutual, to the particles j. The
/// sums of i and j stand in the order of their blocks.
template <class Shape, class Rates, class Terms, int Dim, typename T, class V>
HWY_INLINE void add_rates(const PairList::Chunk& list, std::size_t c, PairView<T, Dim> other,
                          const OriginShift<T, Dim>& shift, const OfI<T, std::array<V, Dim>>& x_i,
                          const Terms& terms, const OfI<T, PairI<V, Dim>>& i,
                          OfI<T, std::array<V, Rates::blocks.count>>& of_i, T* sums) {
  constexpr const SumBlocks<Dim>& blocks = Rates::blocks;
  constexpr std::size_t kVectors = Blocks<T>::i_vectors;
  const std::uint32_t* HWY_RESTRICT targets = list.targets.data();
  const auto body = [&](const PairJ<T, Dim>& j, const auto& x_seen, std::size_t n,
                        std::size_t part) SLUICE_ATTR {
    OfI<T, std::array<V, blocks.count>> of_j;
    unroll<kVectors>([&](auto k) SLUICE_ATTR {
      add_pairs<Shape, Rates, Dim>(terms, i[k], j, j.away_from(x_seen[k]), of_i[k], of_j[k]);
    });
    if constexpr (Terms::mutual) {
      const auto of_all = array_of<blocks.count>([&](auto block) SLUICE_ATTR {
        return add_vectors(array_of<kVectors>([&](auto k) SLUICE_ATTR { return of_j[k][block]; }));
      });
      subtract_from_j<blocks.stride>(place_of(sums, blocks.stride, targets, n, part), of_all);
    }
  };
  for_each_pair<Dim, T>(list, c, other, shift, x_i, body);
}

/// What the terms need of the particles i from `slot` on.
template <typename T, int Dim>
HWY_INLINE auto load_pair_i(const PairView<T, Dim>& self, std::size_t slot) {
  const typename Blocks<T>::D d;
  using V = typename Blocks<T>::V;
  using Fields = PairFields<Dim>;
  const auto field = [&](std::size_t which) SLUICE_ATTR {
    return load_i(self.values + Fields::begin(which) + Fields::at(slot));
  };
  const V excess = field(Fields::excess);
  PairI<V, Dim> i;
  i.velocity = load_i_axes<Dim>(self.values + Fields::begin(Fields::velocity) + Fields::at(slot));
  i.speed = hn::Sqrt(dot(i.velocity, i.velocity));
  i.density = hn::Set(d, T{1}) + excess;
  i.half = hn::MulAdd(hn::Set(d, T{0.5}), excess, hn::Set(d, T{1}));
  i.volume = field(Fields::volume);
  i.diffused = field(self.diffused);
  i.pressure_term = field(Fields::pressure_term);
  return i;
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
    const std::size_t slot = kCluster * (task.first_cluster + c);
    const auto x_i = load_places(task.self, slot);
    const auto i = array_of<B::i_vectors>(
        [&](auto k) SLUICE_ATTR { return load_pair_i(task.self, slot + k * B::i_count); });
    OfI<T, std::array<V, blocks.count>> of_i;
    unroll<B::i_vectors>([&](auto k) SLUICE_ATTR {
      unroll<blocks.count>([&](auto block) SLUICE_ATTR { of_i[k][block] = hn::Zero(d); });
    });
    add_rates<Shape, Rates, decltype(in_fluid), Dim>(*task.to_fluid, c, task.fluid, shift, x_i,
                                                     in_fluid, i, of_i, task.sums);
    if (task.to_wall != nullptr) {
      add_rates<Shape, Rates, decltype(at_walls), Dim>(*task.to_wall, c, task.wall, shift, x_i,
                                                       at_walls, i, of_i, task.sums);
    }
    T* const sums = task.sums + blocks.stride * c;
    unroll<B::i_vectors>([&](auto k) SLUICE_ATTR {
      unroll<blocks.count>([&](auto block) SLUICE_ATTR {
        add_lanes(of_i[k][block], sums + kCluster * block + k * B::i_count);
      });
    });
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
