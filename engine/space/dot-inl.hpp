// Dot products and sums over the components of SIMD vectors. Included once per SIMD target.

#if defined(SLUICE_DOT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_DOT_INL
#undef SLUICE_DOT_INL
#else
#define SLUICE_DOT_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

/// a . b of vectors kept one array a component: component k of lane l is a[k] in lane l.
///
/// It folds from the last axis with multiply-adds, in the plane fma(a_x, b_x, a_y b_y). The order
/// is part of every result.
template <class V, std::size_t Dim>
HWY_INLINE V dot(const std::array<V, Dim>& a, const std::array<V, Dim>& b) {
  V sum = a[Dim - 1] * b[Dim - 1];
  for (std::size_t k = Dim - 1; k-- > 0;) {
    sum = hwy::HWY_NAMESPACE::MulAdd(a[k], b[k], sum);
  }
  return sum;
}

/// The same without multiply-adds: each operation is rounded by itself, alike in a vector and
/// alone.
template <class V, std::size_t Dim>
HWY_INLINE V plain_dot(const std::array<V, Dim>& a, const std::array<V, Dim>& b) {
  V sum = a[Dim - 1] * b[Dim - 1];
  for (std::size_t k = Dim - 1; k-- > 0;) sum = a[k] * b[k] + sum;
  return sum;
}

/// |a_x| + |a_y| + ..., from the last axis.
template <class V, std::size_t Dim>
HWY_INLINE V sum_of_sizes(const std::array<V, Dim>& a) {
  V sum = hwy::HWY_NAMESPACE::Abs(a[Dim - 1]);
  for (std::size_t k = Dim - 1; k-- > 0;) sum = hwy::HWY_NAMESPACE::Abs(a[k]) + sum;
  return sum;
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
