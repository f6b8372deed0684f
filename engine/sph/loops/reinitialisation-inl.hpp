// The sums of eq. 10. Included once per SIMD target.

#if defined(SLUICE_REINITIALISATION_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_REINITIALISATION_INL
#undef SLUICE_REINITIALISATION_INL
#else
#define SLUICE_REINITIALISATION_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "engine/sph/loops/pair_loop-inl.hpp"
#include "engine/sph/terms/terms-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Numerator and divisor of eq. 10 for the clusters of a chunk.
template <class Shape, typename T, int Dim>
void sum_reinitialisation(const SweepTask<T, Dim>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const OriginShift<T, Dim>& shift = task.constants->origin_shift;
  constexpr const SumBlocks<Dim>& blocks = kReinitialisationSums<Dim>;
  std::fill_n(task.sums, blocks.stride * task.to_fluid->places(), T{});
  using Fields = PairFields<Dim>;
  constexpr std::size_t kVectors = B::i_vectors;
  for (std::size_t c = 0; c < task.clusters; ++c) {
    const std::size_t slot = kCluster * (task.first_cluster + c);
    const auto x_i = load_places(task.self, slot);
    OfI<T, V> volume_i, numerator_i, excess, weight;
    unroll<kVectors>([&](auto k) SLUICE_ATTR {
      const T* const i = task.self.values + Fields::at(slot + k * B::i_count);
      volume_i[k] = load_i(i + Fields::begin(Fields::volume));
      const V excess_i = load_i(i + Fields::begin(Fields::excess));
      numerator_i[k] = ShepardSummands::numerator(excess_i, volume_i[k]);
      excess[k] = weight[k] = hn::Zero(d);
    });
    const auto add = [&]<Share kShare>(const PairList::Chunk& list,
                                       PairView<T, Dim> other) SLUICE_ATTR {
      const auto add_pairs = [&](const PairJ<T, Dim>& j, const auto& x_seen, std::size_t n,
                                 std::size_t part) SLUICE_ATTR {
        const V volume = j.volume();
        const V s = ShepardSummands::numerator(j.excess(), volume);
        std::array<OfI<T, V>, blocks.count> of_j;
        unroll<kVectors>([&](auto k) SLUICE_ATTR {
          const auto x_ij = j.away_from(x_seen[k]);
          const V w = Shape::value(d, dot(x_ij, x_ij));
          excess[k] = hn::MulAdd(w, s, excess[k]);
          weight[k] = hn::MulAdd(w, volume, weight[k]);
          const V minus_w = hn::Neg(w);
          of_j[blocks.density][k] = minus_w * numerator_i[k];
          of_j[blocks.divisor][k] = minus_w * volume_i[k];
        });
        if constexpr (kShare == Share::both) {
          T* const to = place_of(task.sums, blocks.stride, list.targets.data(), n, part);
          subtract_from_j<blocks.stride>(to, array_of<blocks.count>([&](auto block) SLUICE_ATTR {
                                           return add_vectors(of_j[block]);
                                         }));
        }
      };
      for_each_pair<Dim, T>(list, c, other, shift, x_i, add_pairs);
    };
    add.template operator()<Share::both>(*task.to_fluid, task.fluid);
    if (task.to_wall != nullptr) {
      add.template operator()<Share::i_alone>(*task.to_wall, task.wall);
    }
    T* const sums = task.sums + blocks.stride * c;
    unroll<kVectors>([&](auto k) SLUICE_ATTR {
      add_lanes(excess[k], sums + kCluster * blocks.density + k * B::i_count);
      add_lanes(weight[k], sums + kCluster * blocks.divisor + k * B::i_count);
    });
  }
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
