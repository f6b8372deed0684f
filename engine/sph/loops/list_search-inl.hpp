// The search for pairs: clusters whose boxes meet, then those of which two particles may meet.
// Included once per SIMD target.

#if defined(SLUICE_LIST_SEARCH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_LIST_SEARCH_INL
#undef SLUICE_LIST_SEARCH_INL
#else
#define SLUICE_LIST_SEARCH_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "engine/sph/loops/boxes-inl.hpp"
#include "engine/sph/loops/pair_loop-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Rows hold a few clusters that are near, a vector of them or less.
inline std::size_t search_boxes(const SearchTask& task) {
  const hn::CappedTag<float, kTail> d;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  const auto left = hn::Set(d, task.left);
  const auto right = hn::Set(d, task.right);
  const auto low = hn::Set(d, task.low);
  const auto high = hn::Set(d, task.high);
  const auto left_after = hn::Set(d, task.left_after);
  const BoxesView& boxes = task.boxes;
  std::size_t found = 0;
  for (SearchTask::Row& row : task.rows) {
    std::uint32_t j = std::max(row.next, task.first);
    for (; j < row.end; j += lanes) {
      const auto reached = hn::LoadU(d, boxes.x_max_before + j) >= left_after;
      const auto first = hn::FindFirstTrue(d, reached);
      if (first < 0) continue;
      j += static_cast<std::uint32_t>(first);
      break;
    }
    row.next = j;
    for (; j < row.end; j += lanes) {
      const auto level =
          hn::And(hn::LoadU(d, boxes.y_max + j) >= low, hn::LoadU(d, boxes.y_min + j) <= high);
      const auto near = hn::And(clusters_within(d, boxes, j, row.end, left, right), level);
      found += list_slots(d, near, j + (kSameOriginCell << PairList::kShiftBit), task.out + found);
      if (j + lanes < row.end && boxes.x_min_after[j + lanes] > task.right) break;
    }
  }
  return found;
}

/// Where the particles i or j of a vector are in the middle of the lists' lifetime, their
/// velocities and what they may be off.
template <class V>
struct PathOf {
  V x, y, u, v, skin;
};

template <typename T, class V, class Load>
HWY_INLINE PathOf<V> load_path(const ListPathsView<T>& paths, std::size_t slot, const Load& load) {
  const typename Blocks<T>::D d;
  constexpr Skin<T> skin = kSkin<T>;
  const V half_life = hn::Set(d, T{0.5} * skin.lifetime);
  const V u = load(paths.u + slot);
  const V v = load(paths.v + slot);
  return {hn::MulAdd(half_life, u, load(paths.x + slot)),
          hn::MulAdd(half_life, v, load(paths.y + slot)), u, v,
          hn::MulAdd(hn::Set(d, skin.per_speed), hn::Abs(u) + hn::Abs(v), hn::Set(d, skin.least))};
}

template <typename T>
std::size_t prune_list(const PruneTask<T>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const OriginShift<T> shift(task.origin_cell_size);
  constexpr std::size_t parts = kCluster / B::i_count;
  const auto of_i = [](const T* from) HWY_ATTR { return load_i(from); };
  const auto of_j = [](const T* from) HWY_ATTR { return load_j(from); };
  const V half_life = hn::Set(d, T{0.5} * kSkin<T>.lifetime);
  PathOf<V> i[parts];
  for (std::size_t part = 0; part < parts; ++part) {
    i[part] = load_path<T, V>(task.self, kCluster * task.cluster + part * B::i_count, of_i);
    i[part].skin = i[part].skin + hn::Set(d, task.cut_off);
  }
  std::size_t kept = 0;
  for (std::size_t n = 0; n < task.count; ++n) {
    const std::uint32_t entry = task.candidates[n];
    const std::size_t slot = kCluster * (entry & PairList::kClusterMask);
    const std::uint32_t code = entry >> PairList::kShiftBit;
    bool near = false;
    for (std::size_t k = 0; k < B::j_vectors; ++k) {
      const auto j = load_path<T, V>(task.other, slot + k * B::j_lanes, of_j);
      for (std::size_t part = 0; part < parts; ++part) {
        const V dx = i[part].x + hn::Set(d, shift.x[code]) - j.x;
        const V dy = i[part].y + hn::Set(d, shift.y[code]) - j.y;
        const V passing = hn::Abs(i[part].u - j.u) + hn::Abs(i[part].v - j.v);
        const V limit = hn::MulAdd(half_life, passing, i[part].skin + j.skin);
        near |= !hn::AllFalse(d, hn::MulAdd(dx, dx, dy * dy) < limit * limit);
      }
    }
    task.out[kept] = entry;
    kept += near ? 1U : 0U;
  }
  return kept;
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
