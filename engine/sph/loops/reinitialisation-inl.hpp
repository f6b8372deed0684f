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
  for (std::size_t c = 0; c < task.clusters; ++c) {
    for (std::size_t part = 0; part < kCluster; part += B::i_count) {
      const std::size_t slot = kCluster * (task.first_cluster + c) + part;
      const auto x_i = load_i<Dim>(task.self.position, slot);
      const V volume_i = load_i(task.self.volume + slot);
      const V numerator_i = ShepardSummands::numerator(load_i(task.self.excess + slot), volume_i);
      V excess = hn::Zero(d);
      V weight = hn::Zero(d);
      const auto add = [&]<Share kShare>(const PairList::Chunk& list,
                                         const PairView<T, Dim>& other) HWY_ATTR {
        const auto add_pairs = [&](std::size_t j, const std::array<V, Dim>& x_ij, std::size_t n,
                                   std::size_t of_j) HWY_ATTR {
          const V w = Shape::value(d, dot(x_ij, x_ij));
          const V volume = load_j(other.volume + j);
          const V s = ShepardSummands::numerator(load_j(other.excess + j), volume);
          excess = hn::MulAdd(w, s, excess);
          weight = hn::MulAdd(w, volume, weight);
          if constexpr (kShare == Share::both) {
            const V minus_w = hn::Neg(w);
            std::array<V, blocks.count> sums_of_j;
            sums_of_j[blocks.density] = minus_w * numerator_i;
            sums_of_j[blocks.divisor] = minus_w * volume_i;
            T* const to = place_of(task.sums, blocks.stride, list, n, of_j);
            subtract_from_j<blocks.stride>(to, sums_of_j);
          }
        };
        for_each_pair<Dim>(list, c, other, shift, x_i, add_pairs);
      };
      add.template operator()<Share::both>(*task.to_fluid, task.fluid);
      if (task.to_wall != nullptr) {
        add.template operator()<Share::i_alone>(*task.to_wall, task.wall);
      }
      T* const sums = task.sums + blocks.stride * c + part;
      add_lanes(excess, sums + kCluster * blocks.density);
      add_lanes(weight, sums + kCluster * blocks.divisor);
    }
  }
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
