// Short loops, written out. Included once per SIMD target.

#if defined(SLUICE_UNROLL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_UNROLL_INL
#undef SLUICE_UNROLL_INL
#else
#define SLUICE_UNROLL_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

/// Calls f(0), ... f(kCount - 1). Written out, so that an array of SIMD vectors, such as the
/// components of one, stays in registers.
template <int kCount, class F>
HWY_INLINE void unroll(const F& f) {
  [&]<std::size_t... k>(std::index_sequence<k...>) HWY_ATTR { (f(k), ...); }
  (std::make_index_sequence<kCount>());
}

/// The array of f(0), ... f(kCount - 1).
template <int kCount, class F>
HWY_INLINE auto array_of(const F& f) {
  return [&]<std::size_t... k>(std::index_sequence<k...>) HWY_ATTR { return std::array{f(k)...}; }
  (std::make_index_sequence<kCount>());
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
