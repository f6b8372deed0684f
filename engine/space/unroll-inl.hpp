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

/// HWY_ATTR for a lambda that is part of a loop: one that stayed a call would take its vectors
/// through memory, and g++ decides by the size of all that a file holds.
#undef SLUICE_ATTR
#define SLUICE_ATTR HWY_ATTR __attribute__((always_inline))

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

/// Calls f(0), ... f(kCount - 1). Written out, so that an array of SIMD vectors, such as the
/// components of one, stays in registers.
template <int kCount, class F>
HWY_INLINE void unroll(const F& f) {
  [&]<std::size_t... k>(std::index_sequence<k...>) SLUICE_ATTR { (f(k), ...); }
  (std::make_index_sequence<kCount>());
}

/// The array of f(0), ... f(kCount - 1).
template <int kCount, class F>
HWY_INLINE auto array_of(const F& f) {
  using Each = decltype(f(std::size_t{}));
  return [&]<std::size_t... k>(std::index_sequence<k...>) SLUICE_ATTR {
    return std::array<Each, kCount>{f(k)...};
  }
  (std::make_index_sequence<kCount>());
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
