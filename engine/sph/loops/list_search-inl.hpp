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
#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/sph/loops/boxes-inl.hpp"
#include "engine/sph/loops/pair_loop-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Squares of the distances of boxes from one box.
template <class D, class V, std::size_t Dim>
HWY_INLINE V distance_sq(D d, const BoxesView<static_cast<int>(Dim)>& boxes, std::uint32_t j,
                         const std::array<V, Dim>& low, const std::array<V, Dim>& high) {
  const auto gap = array_of<Dim>([&](auto axis) SLUICE_ATTR {
    const V behind = hn::LoadU(d, boxes.min[axis] + j) - high[axis];
    const V before = low[axis] - hn::LoadU(d, boxes.max[axis] + j);
    return hn::Max(hn::Max(behind, before), hn::Zero(d));
  });
  return dot(gap, gap);
}

/// Rows hold a few clusters that are near, a vector of them or less.
template <int Dim>
std::size_t search_boxes(const SearchTask<Dim>& task) {
  using Entry = ListEntry<Dim>;
  const hn::CappedTag<float, kTail> d;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  const auto low = array_of<Dim>([&](auto axis) SLUICE_ATTR { return hn::Set(d, task.low[axis]); });
  const auto high =
      array_of<Dim>([&](auto axis) SLUICE_ATTR { return hn::Set(d, task.high[axis]); });
  const auto left_after = hn::Set(d, task.left_after);
  const auto range_sq = hn::Set(d, task.range * task.range);
  const float right = task.high[0] + task.range;
  const BoxesView<Dim> boxes = task.boxes;
  std::size_t found = 0;
  for (auto& row : task.rows) {
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
      const auto near =
          hn::And(distance_sq(d, boxes, j, low, high) <= range_sq, hn::FirstN(d, row.end - j));
      found += list_slots(d, near, Entry::of(j, Entry::kSameOriginCell), task.out + found);
      if (j + lanes < row.end && boxes.x_min_after[j + lanes] > right) break;
    }
  }
  return found;
}

/// Where the particles i or j of a vector are in the middle of the lists' lifetime, their
/// velocities and what they may be off.
template <class V, int Dim>
struct PathOf {
  std::array<V, Dim> middle, velocity;
  V skin;
};

template <class V, int Dim, typename T, class Load>
HWY_INLINE PathOf<V, Dim> load_path(const ListPathsView<T, Dim>& paths, std::size_t slot,
                                    const Load& load) {
  const typename Blocks<T>::D d;
  const Skin<T>& skin = paths.skin;
  const V half_life = hn::Set(d, T{0.5} * skin.lifetime);
  PathOf<V, Dim> path;
  unroll<Dim>([&](auto axis) SLUICE_ATTR {
    path.velocity[axis] = load(paths.velocity[axis] + slot);
    path.middle[axis] =
        hn::MulAdd(half_life, path.velocity[axis], load(paths.position[axis] + slot));
  });
  path.skin =
      hn::MulAdd(hn::Set(d, skin.per_speed), sum_of_sizes(path.velocity), hn::Set(d, skin.least));
  return path;
}

template <typename T, int Dim>
std::size_t prune_list(const PruneTask<T, Dim>& task) {
  using Entry = ListEntry<Dim>;
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  constexpr std::size_t parts = kCluster / B::i_count;
  const auto of_i = [](const T* from) SLUICE_ATTR { return load_i(from); };
  const auto of_j = [](const T* from) SLUICE_ATTR { return load_j(from); };
  // Walls are at rest for ever, and lists serve as long as those of the fluid.
  const T lifetime = std::max(task.self.skin.lifetime, task.other.skin.lifetime);
  const V half_life = hn::Set(d, T{0.5} * lifetime);
  PathOf<V, Dim> paths_i[parts];
  unroll<parts>([&](auto part) SLUICE_ATTR {
    const std::size_t slot = kCluster * task.cluster + part * B::i_count;
    paths_i[part] = load_path<V>(task.self, slot, of_i);
    paths_i[part].skin = paths_i[part].skin + hn::Set(d, task.cut_off);
  });
  std::size_t kept = 0;
  for (std::size_t n = 0; n < task.count; ++n) {
    const std::uint32_t entry = task.candidates[n];
    const std::size_t slot = kCluster * Entry::cluster(entry);
    const std::uint32_t code = Entry::code(entry);
    const auto away = array_of<Dim>(
        [&](auto axis) SLUICE_ATTR { return hn::Set(d, task.shift->of[axis][code]); });
    bool near = false;
    for (std::size_t k = 0; k < B::j_vectors; ++k) {
      const PathOf<V, Dim> j = load_path<V>(task.other, slot + k * B::j_lanes, of_j);
      for (const PathOf<V, Dim>& i : paths_i) {
        const auto x_ij = array_of<Dim>(
            [&](auto axis) SLUICE_ATTR { return i.middle[axis] + away[axis] - j.middle[axis]; });
        const auto v_ij = array_of<Dim>(
            [&](auto axis) SLUICE_ATTR { return i.velocity[axis] - j.velocity[axis]; });
        const V limit = hn::MulAdd(half_life, sum_of_sizes(v_ij), i.skin + j.skin);
        near |= !hn::AllFalse(d, dot(x_ij, x_ij) < limit * limit);
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
