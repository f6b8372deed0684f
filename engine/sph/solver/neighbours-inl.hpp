#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/sph/solver/neighbours.hpp"

namespace sluice {
namespace neighbours {

// Of differences of bounds; the bounds themselves are rounded outwards.
inline constexpr float kSlack = 1e-3F;

/// The entries' origin cells as seen from that of cluster i.
template <int Dim>
void note_origin_cells(const typename Grid<Dim>::OriginCell& i, const ClusterBounds<Dim>& other,
                       std::span<std::uint32_t> entries) {
  using Entry = ListEntry<Dim>;
  for (std::uint32_t& entry : entries) {
    const std::uint32_t cluster = Entry::cluster(entry);
    OriginStep<Dim> step = other.origin_cell[cluster];
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      step[axis] = std::clamp(step[axis] - i[axis], -1, 1);
    }
    entry = Entry::of(cluster, Entry::code_of(step));
  }
}

/// Walks the clusters of `other` beside those of one row of `self`, left to right.
template <int Dim>
class RowSearch {
 public:
  RowSearch(const Layout& layout, const ClusterBounds<Dim>& bounds, float cut_off)
      : layout_(layout), bounds_(bounds), range_(cut_off + kSlack) {}

  /// Starts at the row `row` of `self`. Rows of `other` before `first_row` are left out.
  void start(const ClusterBounds<Dim>& self, std::size_t row, std::size_t first_row) {
    rows_.clear();
    room_ = kTail;
    std::array<float, Dim> low{};
    std::array<float, Dim> high{};
    for (std::size_t axis = 1; axis < Dim; ++axis) {
      low[axis] = self.row_min[axis][row] - range_;
      high[axis] = self.row_max[axis][row] + range_;
    }
    bounds_.for_rows_in(low, high, first_row, [&](std::size_t near) {
      const std::uint32_t begin = layout_.row_begin[near];
      const std::uint32_t end = layout_.row_begin[near + 1];
      rows_.push_back({begin, end});
      room_ += end - begin;
    });
  }

  /// Most entries of a cluster of this row, and the room that the search needs beyond.
  [[nodiscard]] std::size_t room() const { return room_; }

  /// What to search for cluster `i` of `self`, the clusters of a row in their order. Clusters of
  /// `other` before `first` are left out.
  [[nodiscard]] SearchTask<Dim> task(const ClusterBounds<Dim>& self, std::size_t i,
                                     std::size_t first, std::uint32_t* out) {
    SearchTask<Dim> task;
    task.boxes = bounds_.view();
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      task.low[axis] = self.min[axis][i];
      task.high[axis] = self.max[axis][i];
    }
    task.range = range_;
    task.left_after = self.x_min_after[i] - range_;
    task.first = static_cast<std::uint32_t>(first);
    task.rows = rows_;
    task.out = out;
    return task;
  }

 private:
  const Layout& layout_;
  const ClusterBounds<Dim>& bounds_;
  float range_;
  std::vector<typename SearchTask<Dim>::Row> rows_;
  std::size_t room_ = 0;
};

/// Gives every entry of a mutual list its place in the chunk's sums.
template <int Dim>
void assign_places(std::size_t first, std::size_t count, std::size_t clusters,
                   PairList::Chunk& chunk) {
  constexpr std::uint32_t kNone = ~0U;
  // Of every cluster; all kNone between calls, so that only the halos are reset.
  thread_local std::vector<std::uint32_t> place;
  if (place.size() < clusters) place.assign(clusters, kNone);
  resize_closely(chunk.targets, chunk.entries.size());
  chunk.halos.clear();
  for (std::size_t e = 0; e < chunk.entries.size(); ++e) {
    const std::uint32_t j = ListEntry<Dim>::cluster(chunk.entries[e]);
    if (j < first + count) {
      chunk.targets[e] = j - static_cast<std::uint32_t>(first);
      continue;
    }
    if (place[j] == kNone) {
      place[j] = static_cast<std::uint32_t>(count + chunk.halos.size());
      chunk.halos.push_back(j);
    }
    chunk.targets[e] = place[j];
  }
  for (const std::uint32_t j : chunk.halos) place[j] = kNone;
  // A cluster with itself gets all its pairs from its own side.
  const auto nobody = static_cast<std::uint32_t>(chunk.places() - 1);
  for (std::size_t n = 0; n < count; ++n) {
    if (chunk.begin[n] != chunk.begin[n + 1]) chunk.targets[chunk.begin[n]] = nobody;
  }
}

/// The list of the chunk `number`.
template <typename T, int Dim>
void build_chunk(const Sweeps<T, Dim>& sweeps, const PairRange<T, Dim>& range,
                 const NewPairList<T, Dim>& wanted, std::size_t number) {
  const PairSet<T, Dim>& self = *wanted.self;
  const PairSet<T, Dim>& other = *wanted.other;
  const bool mutual = wanted.self == wanted.other;
  PairList::Chunk& chunk = wanted.list->chunks[number];
  const std::size_t first = self.layout.chunk_begin(number);
  const std::size_t count = self.layout.chunk_begin(number + 1) - first;
  chunk.begin.assign(count + 1, 0);

  // The thread's own, so that a chunk's list is no longer than what it holds.
  thread_local std::vector<std::uint32_t> candidates;
  thread_local std::vector<std::uint32_t> entries;
  RowSearch<Dim> search(other.layout, other.bounds, static_cast<float>(range.cut_off));
  const ClusterBounds<Dim>& bounds = self.bounds;
  const auto& rows = self.layout.row_begin;
  auto row_end = rows.begin();  // end of the row of the last cluster
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t c = first + n;
    chunk.begin[n + 1] = chunk.begin[n];
    if (c >= rows.back() || bounds.min[0][c] > bounds.max[0][c]) continue;  // empty
    if (row_end == rows.begin() || c >= *row_end) {
      row_end = std::upper_bound(rows.begin(), rows.end(), static_cast<std::uint32_t>(c));
      const auto s = static_cast<std::size_t>(row_end - rows.begin()) - 1;
      search.start(bounds, s, mutual ? s : 0);
      if (candidates.size() < search.room()) candidates.resize(search.room());
    }
    const std::size_t found =
        sweeps.search(search.task(bounds, c, mutual ? c : 0, candidates.data()));
    if (!range.one_origin_cell)
      note_origin_cells<Dim>(bounds.origin_cell[c], other.bounds, {candidates.data(), found});
    if (entries.size() < chunk.begin[n] + found) entries.resize(2 * (chunk.begin[n] + found));
    const std::size_t kept =
        sweeps.prune({self.paths, other.paths, range.cut_off, &range.shift, c, candidates.data(),
                      found, entries.data() + chunk.begin[n]});
    chunk.begin[n + 1] = chunk.begin[n] + static_cast<std::uint32_t>(kept);
  }
  resize_closely(chunk.entries, chunk.begin.back());
  std::copy_n(entries.begin(), chunk.begin.back(), chunk.entries.begin());
  if (mutual) assign_places<Dim>(first, count, self.layout.clusters(), chunk);
}

}  // namespace neighbours

template <typename T, int Dim>
void build_pair_lists(ThreadTeam& team, const Sweeps<T, Dim>& sweeps,
                      const PairRange<T, Dim>& range, std::span<const NewPairList<T, Dim>> lists) {
  std::size_t tasks = 0;
  for (const NewPairList<T, Dim>& one : lists) {
    one.list->chunks.resize(one.self->layout.chunks());
    tasks += one.list->chunks.size();
  }
  team.run(tasks, [&](std::size_t task) {
    auto wanted = lists.begin();
    for (; task >= wanted->list->chunks.size(); ++wanted) task -= wanted->list->chunks.size();
    neighbours::build_chunk(sweeps, range, *wanted, task);
  });
}

}  // namespace sluice
