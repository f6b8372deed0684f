// The loops over particles, in one table. Included once per SIMD target. Plain arithmetic: each
// element is rounded the same way in a vector and alone, which is what exact restart needs (the
// build forbids contraction).

#if defined(SLUICE_UPDATES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_UPDATES_INL
#undef SLUICE_UPDATES_INL
#else
#define SLUICE_UPDATES_INL
#endif

#include <hwy/highway.h>

#include "engine/sph/loops/measures-inl.hpp"
#include "engine/sph/loops/pair_arrays-inl.hpp"
#include "engine/sph/loops/steps-inl.hpp"
#include "engine/sph/loops/sums_around-inl.hpp"
#include "engine/sph/loops/updates.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <typename T, int Dim>
void fill_updates(Updates<T, Dim>& out) {
  out.leap_frog = &leap_frog<T, Dim>;
  out.kick_drift = &kick_drift<Dim>;
  out.density_drift = &density_drift<T, Dim>;
  out.shift = &shift<T, Dim>;
  out.kick = &kick<T, Dim>;
  out.write_places = &write_places<T, Dim>;
  out.write_velocities = &write_velocities<T, Dim>;
  out.write_densities = &write_densities<T, Dim>;
  out.compare = &compare_with_paths<T, Dim>;
  out.gather = &gather<T>;
  out.reinitialise = &reinitialise_density<T, Dim>;
  out.measure = &measure<Dim>;
  out.measure_acceleration = &measure_acceleration<Dim>;
  out.measure_rates = &measure_rates<T, Dim>;
  out.sum_energy = &sum_energy<Dim>;
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
