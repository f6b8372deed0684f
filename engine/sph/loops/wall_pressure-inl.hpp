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
    for (std::size_t part = 0; part < kCluster; part += B::i_count) {
      const std::size_t slot = kCluster * (task.first_cluster + c) + part;
      V pressure = hn::Zero(d);
      V weight = hn::Zero(d);
      const auto add = [&](std::size_t j, const std::array<V, Dim>& x_ij, std::size_t, std::size_t)
                           HWY_ATTR {
                             const V w = Shape::value(d, dot(x_ij, x_ij));
                             const V p = term.summand(d, x_ij, load_j(task.fluid.excess + j));
                             pressure = hn::MulAdd(w, p, pressure);
                             weight = weight + w;
                           };
      for_each_pair<Dim>(*task.to_fluid, c, task.fluid, shift,
                         load_i<Dim>(task.self.position, slot), add);
      T above[B::i_count] = {};
      T below[B::i_count] = {};
      add_lanes(pressure, above);
      add_lanes(weight, below);
      for (std::size_t i = 0; i < B::i_count; ++i) {
        task.sums[slot + i] = below[i] > T{0} ? above[i] / below[i] : T{0};
      }
    }
  }
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
