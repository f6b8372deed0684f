// What every loop over pairs is made of. Included once per SIMD target.
//
// A cluster is four particles. Each sum runs one cluster i against a list of clusters j. A vector
// is seen as blocks of 128 bits: every block holds the same particles j (one broadcast load) and
// belongs to its own particle i, so that no lane is a gather and one reduction at the end serves
// all i of the vector. With AVX-512 a vector holds all four particles i, elsewhere some vectors do,
// side by side: they read the list and the particles j once, and while one waits for a result
// the other goes on. Their sums have the order that AVX-512 gives them.

#if defined(SLUICE_PAIR_LOOP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_PAIR_LOOP_INL
#undef SLUICE_PAIR_LOOP_INL
#else
#define SLUICE_PAIR_LOOP_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/space/dot-inl.hpp"
#include "engine/space/unroll-inl.hpp"
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
  static constexpr std::size_t i_vectors = kCluster / i_count;  ///< vectors that hold a cluster i
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

/// One of each vector of a cluster i.
template <typename T, class Each>
using OfI = std::array<Each, Blocks<T>::i_vectors>;

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

/// The same for all blocks of a place of `kStride` values, in the order of memory.
template <std::size_t kStride, typename T, class V, std::size_t kCount>
HWY_INLINE void subtract_from_j(T* HWY_RESTRICT to, const std::array<V, kCount>& blocks) {
  const typename Blocks<T>::D d;
  constexpr bool wide = Blocks<T>::lanes == 4 * kCluster;
  if constexpr (wide && kCount >= 3 && kStride == Blocks<T>::lanes) {
    // All blocks are one vector; a fourth that nobody sums is not read. Each half holds in two of
    // its blocks what is to be added up for the blocks 0 and 2, and for 1 and 3.
    const V even = hn::ConcatLowerLower(d, blocks[2], blocks[0]) +
                   hn::ConcatUpperUpper(d, blocks[2], blocks[0]);
    V odd = blocks[1];
    if constexpr (kCount == 3) {
      odd = odd + hn::ConcatLowerUpper(d, odd, odd);
    } else {
      odd = hn::ConcatLowerLower(d, blocks[3], odd) + hn::ConcatUpperUpper(d, blocks[3], odd);
    }
    const V sums =
        hn::OddEvenBlocks(odd, even) + hn::SwapAdjacentBlocks(hn::OddEvenBlocks(even, odd));
    hn::StoreU(hn::LoadU(d, to) - sums, d, to);
  } else if constexpr (wide && kCount == 2) {
    const hn::Half<typename Blocks<T>::D> half;
    const auto a = hn::LowerHalf(half, blocks[0]) + hn::UpperHalf(half, blocks[0]);
    const auto b = hn::LowerHalf(half, blocks[1]) + hn::UpperHalf(half, blocks[1]);
    const auto sums = hn::ConcatLowerLower(half, b, a) + hn::ConcatUpperUpper(half, b, a);
    hn::StoreU(hn::LoadU(half, to) - sums, half, to);
  } else {
    unroll<kCount>([&](auto block)
                       SLUICE_ATTR { subtract_from_j(to + kCluster * block, blocks[block]); });
  }
}

/// Adds up the vectors of a cluster i, in the order in which add_blocks goes on.
template <class V, std::size_t kCount>
HWY_INLINE V add_vectors(const std::array<V, kCount>& v) {
  if constexpr (kCount == 1) {
    return v[0];
  } else {
    return add_vectors(
        array_of<kCount / 2>([&](auto k) SLUICE_ATTR { return v[k] + v[k + kCount / 2]; }));
  }
}

/// Place in the sums of the particles j of an entry, or of its vector `part`.
template <typename T>
HWY_INLINE T* place_of(T* sums, std::size_t stride, const std::uint32_t* HWY_RESTRICT targets,
                       std::size_t entry, std::size_t part) {
  return sums + stride * targets[entry] + part * Blocks<T>::j_lanes;
}

/// The components of a vector field, from the place of its first in a cluster on.
template <int Dim, typename T>
HWY_INLINE auto load_i_axes(const T* HWY_RESTRICT from) {
  return array_of<Dim>([&](auto axis) SLUICE_ATTR { return load_i(from + kCluster * axis); });
}

/// The positions of the particles i from `slot` on.
template <int Dim, typename T>
HWY_INLINE auto load_places(const PairView<T, Dim>& view, std::size_t slot) {
  const T* HWY_RESTRICT from = view.values + PairFields<Dim>::at(slot);
  return array_of<Blocks<T>::i_vectors>(
      [&](auto k) SLUICE_ATTR { return load_i_axes<Dim>(from + k * Blocks<T>::i_count); });
}

/// The particles j of a vector, by the place of the first's fields. What is not asked for is not
/// read.
template <typename T, int Dim>
struct PairJ {
  using Fields = PairFields<Dim>;
  const T* at;
  std::size_t psi;

  HWY_INLINE auto field(std::size_t which) const { return load_j(at + Fields::begin(which)); }
  HWY_INLINE auto velocity(std::size_t axis) const { return field(Fields::velocity + axis); }
  HWY_INLINE auto excess() const { return field(Fields::excess); }
  HWY_INLINE auto volume() const { return field(Fields::volume); }
  HWY_INLINE auto diffused() const { return field(psi); }
  HWY_INLINE auto pressure_term() const { return field(Fields::pressure_term); }
  /// x_ij/h.
  template <class V>
  HWY_INLINE std::array<V, Dim> away_from(const std::array<V, Dim>& x_i) const {
    return array_of<Dim>([&](auto axis)
                             SLUICE_ATTR { return x_i[axis] - field(Fields::position + axis); });
  }
};

/// Calls body(j, x_i, entry, part) for every vector of particles j against cluster c, the c-th of
/// the list's chunk; x_i are its positions as seen from there.
template <int Dim, typename T, class X, class Body>
HWY_INLINE void for_each_pair(const PairList::Chunk& list, std::size_t c, PairView<T, Dim> other,
                              const OriginShift<T, Dim>& shift, const X& x_i, const Body& body) {
  using B = Blocks<T>;
  using Entry = ListEntry<Dim>;
  const typename B::D d;
  const std::uint32_t* HWY_RESTRICT entries = list.entries.data();
  std::uint32_t seen_from = Entry::kSameOriginCell;
  X x_seen = x_i;
  const std::size_t end = list.begin[c + 1];
  for (std::size_t n = list.begin[c]; n != end; ++n) {
    const T* HWY_RESTRICT cluster =
        other.values + PairFields<Dim>::at(kCluster * Entry::cluster(entries[n]));
    const std::uint32_t code = Entry::code(entries[n]);
    if (HWY_UNLIKELY(code != seen_from)) {
      seen_from = code;
      unroll<B::i_vectors>([&](auto k) SLUICE_ATTR {
        unroll<Dim>([&](auto axis) SLUICE_ATTR {
          x_seen[k][axis] = x_i[k][axis] + hn::Set(d, shift.of[axis][code]);
        });
      });
    }
    for (std::size_t part = 0; part < B::j_vectors; ++part) {
      body(PairJ<T, Dim>{cluster + part * B::j_lanes, other.diffused}, x_seen, n, part);
    }
  }
}

/// Who gets the sums of a list: the particles i, or both of a pair.
enum class Share { i_alone, both };

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
