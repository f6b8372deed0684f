// The loops over pairs, chosen for a method. Included once per SIMD target by each
// sweeps_<type>_<d>.cpp.

#if defined(SLUICE_SWEEPS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_SWEEPS_INL
#undef SLUICE_SWEEPS_INL
#else
#define SLUICE_SWEEPS_INL
#endif

#include <hwy/highway.h>

#include "engine/sph/kernel/kernel-inl.hpp"
#include "engine/sph/loops/list_search-inl.hpp"
#include "engine/sph/loops/rates-inl.hpp"
#include "engine/sph/loops/reinitialisation-inl.hpp"
#include "engine/sph/loops/sweeps.hpp"
#include "engine/sph/loops/updates-inl.hpp"
#include "engine/sph/loops/wall_pressure-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Shape, typename T, int Dim>
void fill_sweeps(const MethodN<Dim>& method, Sweeps<T, Dim>& out) {
  if (method.integrator == Integrator::modified_leap_frog) {
    out.density_and_acceleration = select_rates<Shape, Sums::both, T, Dim>(method);
  } else {
    out.density = select_rates<Shape, Sums::density, T, Dim>(method);
    out.density_and_shift = select_rates<Shape, Sums::density, T, Dim, true>(method);
    out.acceleration = select_rates<Shape, Sums::acceleration, T, Dim>(method);
  }
  out.wall_pressure = &sum_wall_pressure<Shape, T, Dim>;
  out.reinitialise = &sum_reinitialisation<Shape, T, Dim>;
  out.updates.sum_around = &sum_around<Shape, Dim>;
  out.search = &search_boxes<Dim>;
  out.prune = &prune_list<T, Dim>;
  out.target = hwy::TargetName(HWY_TARGET);
}

template <typename T, int Dim>
void fill(const MethodN<Dim>& method, Sweeps<T, Dim>& out) {
  fill_updates(out.updates);
  if (method.kernel == KernelKind::truncated_gaussian) {
    fill_sweeps<GaussianShape>(method, out);
  } else {
    fill_sweeps<WendlandShape>(method, out);
  }
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
