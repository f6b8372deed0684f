// State and sums as vectors. Included once per SIMD target.

#if defined(SLUICE_STATE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_STATE_INL
#undef SLUICE_STATE_INL
#else
#define SLUICE_STATE_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <type_traits>

#include "engine/space/dot-inl.hpp"
#include "engine/space/unroll-inl.hpp"
#include "engine/sph/loops/updates.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// As many state values as a cluster has, or a vector holds.
using State = hn::CappedTag<double, kCluster>;
using StateVec = hn::Vec<State>;

/// Sums of the particles from slot s on, of one block.
template <typename T, int Dim>
HWY_INLINE StateVec load_sums(const Rates<T, Dim>& rates, std::size_t block, std::size_t s) {
  const State d;
  const hn::Rebind<T, State> d_sum;
  const std::size_t n = s - rates.first_slot;
  const T* from =
      rates.sums + rates.blocks.stride * (n / kCluster) + kCluster * block + n % kCluster;
  if constexpr (std::is_same_v<T, double>) {
    return hn::LoadU(d, from);
  } else {
    return hn::PromoteTo(d, hn::LoadU(d_sum, from));
  }
}

template <typename T, int Dim>
HWY_INLINE StateVec load_density_rate(const Rates<T, Dim>& rates, std::size_t s) {
  const State d;
  return hn::Set(d, rates.density_scale) * load_sums(rates, rates.blocks.density, s);
}
template <typename T, int Dim>
HWY_INLINE StateVec load_acceleration(const Rates<T, Dim>& rates, std::size_t axis, std::size_t s) {
  const State d;
  return hn::Set(d, rates.acceleration_scale) * load_sums(rates, rates.blocks.vector[axis], s) +
         hn::Set(d, rates.gravity[static_cast<Eigen::Index>(axis)]);
}

/// The components of a vector field of the particles from slot s on.
template <int Dim, class D, class Pointer>
HWY_INLINE auto load_axes(D d, const std::array<Pointer, Dim>& field, std::size_t s) {
  return array_of<Dim>([&](auto axis) HWY_ATTR { return hn::LoadU(d, field[axis] + s); });
}

template <class V>
HWY_INLINE void add_scaled(double* HWY_RESTRICT to, V value, double factor) {
  const hn::DFromV<V> d;
  hn::StoreU(hn::LoadU(d, to) + hn::Set(d, factor) * value, d, to);
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
