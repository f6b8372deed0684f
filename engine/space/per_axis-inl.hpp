// Loops over the axes, unrolled. Included once per SIMD target.

#if defined(SLUICE_PER_AXIS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_PER_AXIS_INL
#undef SLUICE_PER_AXIS_INL
#else
#define SLUICE_PER_AXIS_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

/// Calls f(axis) for all axes. Written out, so that components of SIMD vectors stay in registers.
template <int Dim, class F>
HWY_INLINE void for_axes(const F& f) {
  [&]<std::size_t... axis>(std::index_sequence<axis...>) HWY_ATTR { (f(axis), ...); }
  (std::make_index_sequence<Dim>());
}

/// f(axis) of all axes.
template <int Dim, class F>
HWY_INLINE auto per_axis(const F& f) {
  return [&]<std::size_t... axis>(std::index_sequence<axis...>) HWY_ATTR {
    return std::array{f(axis)...};
  }
  (std::make_index_sequence<Dim>());
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
