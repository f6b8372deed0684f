// Clusters by their boxes. Included once per SIMD target.

#if defined(SLUICE_BOXES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_BOXES_INL
#undef SLUICE_BOXES_INL
#else
#define SLUICE_BOXES_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "engine/sph/loops/updates.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Which of the clusters from j on, before `end`, reach into [left, right] of their row.
template <class D, int Dim, class V>
HWY_INLINE auto clusters_within(D d, const BoxesView<Dim>& boxes, std::uint32_t j,
                                std::uint32_t end, V left, V right) {
  const auto beside =
      hn::And(hn::LoadU(d, boxes.max[0] + j) >= left, hn::LoadU(d, boxes.min[0] + j) <= right);
  return hn::And(beside, hn::FirstN(d, end - j));
}

/// Writes first + k for the lanes k of the mask, and a vector's worth beyond; returns how many they
/// are.
template <class D, class M>
HWY_INLINE std::size_t list_slots(D d, M mask, std::uint32_t first,
                                  std::uint32_t* HWY_RESTRICT out) {
  const hn::RebindToUnsigned<D> d_number;
  const auto from = hn::Set(d_number, first);
  if constexpr (hn::MaxLanes(D()) == 8) {
    // In place of hn::Compress, whose table for AVX2 g++ copies at every call.
    std::uint8_t bits[8];
    hn::StoreMaskBits(d, mask, bits);
    const hn::Rebind<std::uint8_t, D> d_byte;
    const auto numbers = hn::LoadU(d_byte, kBitsOfByte[bits[0]].data());
    hn::StoreU(hn::PromoteTo(d_number, numbers) + from, d_number, out);
  } else {
    const auto numbers = hn::Iota(d_number, 0) + from;
    hn::StoreU(hn::Compress(numbers, hn::RebindMask(d_number, mask)), d_number, out);
  }
  return hn::CountTrue(d, mask);
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
