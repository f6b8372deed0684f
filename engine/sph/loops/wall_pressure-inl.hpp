// The sums of eq. 9. Included once per SIMD target.

#if defined(SLUICE_WALL_PRESSURE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_WALL_PRESSURE_INL
#undef SLUICE_WALL_PRESSURE_INL
#else
#define SLUICE_WALL_PRESSURE_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>

#include "engine/sph/loops/pair_loop-inl.hpp"
#include "engine/sph/terms/terms-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// eq. 9 for the wall clusters of a chunk; 0 where no fluid is near.
template <class Shape, typename T, int Dim>
void sum_wall_pressure(const SweepTask<T, Dim>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const OriginShift<T, Dim>& shift = task.constants->origin_shift;
  const WallPressureSummand<T, Dim> term{task.constants->gravity};
  for (std::size_t c = 0; c < task.clusters; ++c) {
    const std::size_t slot = kCluster * (task.first_cluster + c);
    OfI<T, V> pressure, weight;
    unroll<B::i_vectors>([&](auto k) SLUICE_ATTR { pressure[k] = weight[k] = hn::Zero(d); });
    const auto add = [&](const PairJ<T, Dim>& j, const auto& x_seen, std::size_t,
                         std::size_t) SLUICE_ATTR {
      unroll<B::i_vectors>([&](auto k) SLUICE_ATTR {
        const auto x_ij = j.away_from(x_seen[k]);
        const V w = Shape::value(d, dot(x_ij, x_ij));
        pressure[k] = hn::MulAdd(w, term.summand(d, x_ij, j.excess()), pressure[k]);
        weight[k] = weight[k] + w;
      });
    };
    for_each_pair<Dim, T>(*task.to_fluid, c, task.fluid, shift, load_places(task.self, slot), add);
    T above[kCluster] = {};
    T below[kCluster] = {};
    unroll<B::i_vectors>([&](auto k) SLUICE_ATTR {
      add_lanes(pressure[k], above + k * B::i_count);
      add_lanes(weight[k], below + k * B::i_count);
    });
    for (std::size_t i = 0; i < kCluster; ++i) {
      task.sums[slot + i] = below[i] > T{0} ? above[i] / below[i] : T{0};
    }
  }
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
