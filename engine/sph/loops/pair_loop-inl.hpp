// What every loop over pairs is made of. Included once per SIMD target.
//
// A cluster is four particles. Each sum runs one cluster i against a list of clusters j. A vector
// is seen as blocks of 128 bits: every block holds the same particles j (one broadcast load) and
// belongs to its own particle i, so that no lane is a gather and one reduction at the end serves
// all i of the vector. With AVX-512 in single precision a vector is all 4 x 4 pairs of two
// clusters.

#if defined(SLUICE_PAIR_LOOP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_PAIR_LOOP_INL
#undef SLUICE_PAIR_LOOP_INL
#else
#define SLUICE_PAIR_LOOP_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "engine/sph/loops/sweeps.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// How a vector of T is cut into blocks.
template <typename T>
struct Blocks {
  using D = hn::CappedTag<T, 64 / sizeof(T)>;
  using V = hn::Vec<D>;
  static constexpr std::size_t lanes = hn::MaxLanes(D());
  static constexpr std::size_t j_lanes = 16 / sizeof(T);        ///< particles j in a block
  static constexpr std::size_t i_count = lanes / j_lanes;       ///< particles i in a vector
  static constexpr std::size_t j_vectors = kCluster / j_lanes;  ///< vectors that hold a cluster j
};

/// Lane k of the result is lane k / j_lanes of what `from` points to: each block gets its particle
/// i.
template <typename T>
HWY_INLINE auto load_i(const T* HWY_RESTRICT from) {
  using B = Blocks<T>;
  const typename B::D d;
  using TI = hwy::MakeSigned<T>;
  HWY_ALIGN static constexpr auto kIndex = [] {
    struct {
      TI lane[B::lanes];
    } index{};
    for (std::size_t k = 0; k < B::lanes; ++k) index.lane[k] = static_cast<TI>(k / B::j_lanes);
    return index;
  }();
  return hn::TableLookupLanes(hn::LoadU(d, from), hn::SetTableIndices(d, kIndex.lane));
}

template <typename T>
HWY_INLINE auto load_j(const T* HWY_RESTRICT from) {
  return hn::LoadDup128(typename Blocks<T>::D(), from);
}

/// Adds up the lanes of each block: one value per particle i.
template <typename T, class V>
HWY_INLINE void add_lanes(V sum, T* HWY_RESTRICT out) {
  using B = Blocks<T>;
  const typename B::D d;
  if constexpr (B::j_lanes == 4) {
    sum = sum + hn::Shuffle1032(sum);
    sum = sum + hn::Shuffle2301(sum);
  } else {
    sum = sum + hn::Shuffle01(sum);
  }
  HWY_ALIGN T lanes[B::lanes];
  hn::Store(sum, d, lanes);
  for (std::size_t i = 0; i < B::i_count; ++i) out[i] += lanes[i * B::j_lanes];
}

/// Adds up the blocks: one value per particle j, in one block.
template <class D, class V>
HWY_INLINE auto add_blocks(D, V v) {
  if constexpr (hn::MaxLanes(D()) * sizeof(hn::TFromD<D>) == 16) {
    return v;
  } else {
    const hn::Half<D> half;
    return add_blocks(half, hn::LowerHalf(half, v) + hn::UpperHalf(half, v));
  }
}

/// What the particles j of an entry get: the sums over i, subtracted, for a pair gives one what it
/// takes from the other. `to` is the entry's place in the sums, at the first of the particles j.
template <typename T, class V>
HWY_INLINE void subtract_from_j(T* HWY_RESTRICT to, V v) {
  const auto sum = add_blocks(typename Blocks<T>::D(), v);
  const hn::CappedTag<T, 16 / sizeof(T)> block;
  hn::StoreU(hn::LoadU(block, to) - sum, block, to);
}

/// The same for two blocks side by side.
template <typename T, class V>
HWY_INLINE void subtract_from_j(T* HWY_RESTRICT to, V first, V second) {
  if constexpr (Blocks<T>::lanes == 4 * kCluster) {
    const hn::Half<typename Blocks<T>::D> half;
    const auto a = hn::LowerHalf(half, first) + hn::UpperHalf(half, first);
    const auto b = hn::LowerHalf(half, second) + hn::UpperHalf(half, second);
    const auto sums = hn::ConcatLowerLower(half, b, a) + hn::ConcatUpperUpper(half, b, a);
    hn::StoreU(hn::LoadU(half, to) - sums, half, to);
  } else {
    subtract_from_j(to, first);
    subtract_from_j(to + kCluster, second);
  }
}

/// For places of which all blocks are one vector: `even` and `odd` hold, in two blocks each, what
/// is to be added up for the blocks 0 and 2, and for 1 and 3.
template <typename T, class V>
HWY_INLINE void subtract_halves(T* HWY_RESTRICT to, V even, V odd) {
  const typename Blocks<T>::D d;
  const V sums =
      hn::OddEvenBlocks(odd, even) + hn::SwapAdjacentBlocks(hn::OddEvenBlocks(even, odd));
  hn::StoreU(hn::LoadU(d, to) - sums, d, to);
}

template <typename T, class V>
HWY_INLINE void subtract_from_j(T* HWY_RESTRICT to, V density, V y, V x) {
  const typename Blocks<T>::D d;
  if constexpr (Blocks<T>::lanes == kRateSums.stride) {
    // The last block is not read.
    const V even = hn::ConcatLowerLower(d, x, density) + hn::ConcatUpperUpper(d, x, density);
    subtract_halves(to, even, V(y + hn::ConcatLowerUpper(d, y, y)));
  } else {
    subtract_from_j(to + kRateSums.density, density);
    subtract_from_j(to + kRateSums.y, y);
    subtract_from_j(to + kRateSums.x, x);
  }
}

template <typename T, class V>
HWY_INLINE void subtract_from_j(T* HWY_RESTRICT to, V density, V y, V x, V trace) {
  const typename Blocks<T>::D d;
  constexpr SumBlocks blocks = kDensityAndShiftingSums;
  if constexpr (Blocks<T>::lanes == blocks.stride) {
    const V even = hn::ConcatLowerLower(d, x, density) + hn::ConcatUpperUpper(d, x, density);
    const V odd = hn::ConcatLowerLower(d, trace, y) + hn::ConcatUpperUpper(d, trace, y);
    subtract_halves(to, even, odd);
  } else {
    subtract_from_j(to + blocks.density, density);
    subtract_from_j(to + blocks.y, y);
    subtract_from_j(to + blocks.x, x);
    subtract_from_j(to + blocks.trace, trace);
  }
}

/// Positions of the particles i as seen from the origin cell of a cluster j.
template <typename T>
struct OriginShift {
  T x[9];
  T y[9];
  explicit OriginShift(T origin_cell_size) {
    for (int code = 0; code < 9; ++code) {
      const int row = code / 3;
      x[code] = -static_cast<T>(code % 3 - 1) * origin_cell_size;
      y[code] = -static_cast<T>(row - 1) * origin_cell_size;
    }
  }
};

/// Place in the sums of the particles j of an entry, or of its vector `part`.
template <typename T>
HWY_INLINE T* place_of(T* sums, std::size_t stride, const PairList::Chunk& list, std::size_t entry,
                       std::size_t part) {
  return sums + stride * list.targets[entry] + part * Blocks<T>::j_lanes;
}

/// Calls body(slot of j, x_ij/h, y_ij/h, entry, part) for every vector of pairs of cluster c, the
/// c-th of the list's chunk.
template <typename T, class V, class Body>
HWY_INLINE void for_each_pair(const PairList::Chunk& list, std::size_t c, const PairView<T>& other,
                              const OriginShift<T>& shift, V x_i, V y_i, const Body& body) {
  using B = Blocks<T>;
  const typename B::D d;
  const std::uint32_t* HWY_RESTRICT entries = list.entries.data();
  std::uint32_t seen_from = kSameOriginCell;
  V x_seen = x_i;
  V y_seen = y_i;
  for (std::size_t n = list.begin[c]; n != list.begin[c + 1]; ++n) {
    const std::size_t slot = kCluster * (entries[n] & PairList::kClusterMask);
    const std::uint32_t code = entries[n] >> PairList::kShiftBit;
    if (HWY_UNLIKELY(code != seen_from)) {
      seen_from = code;
      x_seen = x_i + hn::Set(d, shift.x[code]);
      y_seen = y_i + hn::Set(d, shift.y[code]);
    }
    for (std::size_t part = 0; part < B::j_vectors; ++part) {
      const std::size_t j = slot + part * B::j_lanes;
      body(j, x_seen - load_j(other.x + j), y_seen - load_j(other.y + j), n, part);
    }
  }
}

/// Who gets the sums of a list: the particles i, or both of a pair.
enum class Share { i_alone, both };

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
