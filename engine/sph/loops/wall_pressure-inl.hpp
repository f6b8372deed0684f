// The sums of eq. 9. Included once per SIMD target.

#if defined(SLUICE_WALL_PRESSURE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_WALL_PRESSURE_INL
#undef SLUICE_WALL_PRESSURE_INL
#else
#define SLUICE_WALL_PRESSURE_INL
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "engine/sph/loops/pair_loop-inl.hpp"
#include "engine/sph/terms/terms-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// eq. 9 for the wall clusters of a chunk; 0 where no fluid is near.
template <class Shape, typename T>
void sum_wall_pressure(const SweepTask<T>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const OriginShift<T> shift(task.constants->origin_cell_size);
  const WallPressureSummand<T> term{task.constants->gravity_x, task.constants->gravity_y};
  for (std::size_t c = 0; c < task.clusters; ++c) {
    for (std::size_t part = 0; part < kCluster; part += B::i_count) {
      const std::size_t slot = kCluster * (task.first_cluster + c) + part;
      V pressure = hn::Zero(d);
      V weight = hn::Zero(d);
      for_each_pair(*task.to_fluid, c, task.fluid, shift, load_i(task.self.x + slot),
                    load_i(task.self.y + slot),
                    [&](std::size_t j, V dx, V dy, std::size_t, std::size_t) HWY_ATTR {
                      const V w = Shape::value(d, hn::MulAdd(dx, dx, dy * dy));
                      const V p = term.summand(d, dx, dy, load_j(task.fluid.excess + j));
                      pressure = hn::MulAdd(w, p, pressure);
                      weight = weight + w;
                    });
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
