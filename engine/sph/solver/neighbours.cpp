#include "engine/sph/solver/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sluice {
namespace {

// Of differences of bounds; the bounds themselves are rounded outwards.
constexpr float kSlack = 1e-3F;

/// The entries' origin cells as seen from that of cluster i.
void note_origin_cells(const Grid::OriginCell& i, const ClusterBounds& other,
                       std::span<std::uint32_t> entries) {
  for (std::uint32_t& entry : entries) {
    const std::uint32_t cluster = entry & PairList::kClusterMask;
    const Grid::OriginCell& j = other.origin_cell[cluster];
    const int column = std::clamp(j.column - i.column, -1, 1) + 1;
    const int row = std::clamp(j.row - i.row, -1, 1) + 1;
    entry = cluster | static_cast<std::uint32_t>(row * 3 + column) << PairList::kShiftBit;
  }
}

/// Walks the clusters of `other` beside those of one row of `self`, left to right.
class RowSearch {
 public:
  RowSearch(const Layout& layout, const ClusterBounds& bounds, float cut_off)
      : layout_(layout), bounds_(bounds), range_(cut_off + kSlack) {}

  /// Starts at a new row of `self`, within [low, high]. Rows of `other` before `first_row`
  /// are left out.
  void start(float low, float high, std::size_t first_row) {
    rows_.clear();
    room_ = kTail;
    const std::size_t rows = layout_.row_begin.size() - 1;
    for (std::size_t s = std::max(first_row, bounds_.first_row(low - range_));
         s < rows && bounds_.row_y_min_after[s] <= high + range_; ++s) {
      const std::uint32_t begin = layout_.row_begin[s];
      const std::uint32_t end = layout_.row_begin[s + 1];
      if (bounds_.row_y_max[s] < low - range_ || bounds_.row_y_min[s] > high + range_) continue;
      rows_.push_back({begin, end});
      room_ += end - begin;
    }
  }

  /// Most entries of a cluster of this row, and the room that the search needs beyond.
  [[nodiscard]] std::size_t room() const { return room_; }

  /// What to search for cluster `i` of `self`, the clusters of a row in their order. Clusters of
  /// `other` before `first` are left out.
  [[nodiscard]] SearchTask task(const ClusterBounds& self, std::size_t i, std::size_t first,
                                std::uint32_t* out) {
    return {bounds_.view(),
            self.x_min[i] - range_,
            self.x_max[i] + range_,
            self.y_min[i] - range_,
            self.y_max[i] + range_,
            self.x_min_after[i] - range_,
            static_cast<std::uint32_t>(first),
            rows_,
            out};
  }

 private:
  const Layout& layout_;
  const ClusterBounds& bounds_;
  float range_;
  std::vector<SearchTask::Row> rows_;
  std::size_t room_ = 0;
};

/// Gives every entry of a mutual list its place in the chunk's sums.
void assign_places(std::size_t first, std::size_t count, std::size_t clusters,
                   PairList::Chunk& chunk) {
  constexpr std::uint32_t kNone = ~0U;
  // Of every cluster; all kNone between calls, so that only the halos are reset.
  thread_local std::vector<std::uint32_t> place;
  if (place.size() < clusters) place.assign(clusters, kNone);
  resize_closely(chunk.targets, chunk.entries.size());
  chunk.halos.clear();
  for (std::size_t e = 0; e < chunk.entries.size(); ++e) {
    const std::uint32_t j = chunk.entries[e] & PairList::kClusterMask;
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

constexpr float kHuge = std::numeric_limits<float>::max();

/// A box that is still empty along one axis, in smoothing lengths.
template <typename T>
struct Extent {
  T low = std::numeric_limits<T>::max();
  T high = -std::numeric_limits<T>::max();
  void add(T from, T way, T skin) {
    low = std::min(low, from + std::min(way, T{0}) - skin);
    high = std::max(high, from + std::max(way, T{0}) + skin);
  }
};

/// The list of the chunk `number`.
template <typename T>
void build_chunk(const Sweeps<T>& sweeps, const PairRange<T>& range, const NewPairList<T>& wanted,
                 std::size_t number) {
  const PairSet<T>& self = *wanted.self;
  const PairSet<T>& other = *wanted.other;
  const bool mutual = wanted.self == wanted.other;
  PairList::Chunk& chunk = wanted.list->chunks[number];
  const std::size_t first = self.layout.chunk_begin(number);
  const std::size_t count = self.layout.chunk_begin(number + 1) - first;
  chunk.begin.assign(count + 1, 0);

  // The thread's own, so that a chunk's list is no longer than what it holds.
  thread_local std::vector<std::uint32_t> candidates;
  thread_local std::vector<std::uint32_t> entries;
  RowSearch search(other.layout, other.bounds, static_cast<float>(range.cut_off));
  const ClusterBounds& bounds = self.bounds;
  const auto& rows = self.layout.row_begin;
  auto row_end = rows.begin();  // end of the row of the last cluster
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t c = first + n;
    chunk.begin[n + 1] = chunk.begin[n];
    if (c >= rows.back() || bounds.x_min[c] > bounds.x_max[c]) continue;  // empty
    if (row_end == rows.begin() || c >= *row_end) {
      row_end = std::upper_bound(rows.begin(), rows.end(), static_cast<std::uint32_t>(c));
      const auto s = static_cast<std::size_t>(row_end - rows.begin()) - 1;
      search.start(bounds.row_y_min[s], bounds.row_y_max[s], mutual ? s : 0);
      if (candidates.size() < search.room()) candidates.resize(search.room());
    }
    const std::size_t found =
        sweeps.search(search.task(bounds, c, mutual ? c : 0, candidates.data()));
    if (!range.one_origin_cell)
      note_origin_cells(bounds.origin_cell[c], other.bounds, {candidates.data(), found});
    if (entries.size() < chunk.begin[n] + found) entries.resize(2 * (chunk.begin[n] + found));
    const std::size_t kept =
        sweeps.prune({self.paths, other.paths, range.cut_off, range.origin_cell_size, c,
                      candidates.data(), found, entries.data() + chunk.begin[n]});
    chunk.begin[n + 1] = chunk.begin[n] + static_cast<std::uint32_t>(kept);
  }
  resize_closely(chunk.entries, chunk.begin.back());
  std::copy_n(entries.begin(), chunk.begin.back(), chunk.entries.begin());
  if (mutual) assign_places(first, count, self.layout.clusters(), chunk);
}

}  // namespace

void ClusterBounds::assign_origin_cells(ThreadTeam& team, const Grid& grid, const Layout& layout,
                                        const double* x, const double* y, const double* id) {
  const std::size_t clusters = layout.clusters();
  resize_closely(origin_cell, clusters);
  team.run(layout.chunks(), [&](std::size_t chunk) {
    for (std::size_t c = layout.chunk_begin(chunk); c < layout.chunk_begin(chunk + 1); ++c) {
      const std::size_t first = kCluster * c;
      origin_cell[c] =
          id[first] < 0.0 ? Grid::OriginCell{} : grid.origin_cell({x[first], y[first]});
    }
  });
}

void ClusterBounds::resize(const Layout& layout) {
  for (auto* a : {&x_min, &x_max, &y_min, &y_max, &x_max_before, &x_min_after}) {
    a->resize(layout.clusters());
  }
}

template <typename T>
void ClusterBounds::assign_boxes(std::size_t begin, std::size_t end, const Grid& grid,
                                 double smoothing_length, const ListPathsView<T>& paths) {
  constexpr Skin<T> skin = kSkin<T>;
  for (std::size_t c = begin; c < end; ++c) {
    Extent<T> x;
    Extent<T> y;
    for (std::size_t s = kCluster * c; s < kCluster * (c + 1); ++s) {
      if (!(std::abs(paths.x[s]) < static_cast<T>(kNowhere))) continue;
      const T off = skin.least + skin.per_speed * (std::abs(paths.u[s]) + std::abs(paths.v[s]));
      x.add(paths.x[s], skin.lifetime * paths.u[s], off);
      y.add(paths.y[s], skin.lifetime * paths.v[s], off);
    }
    const bool used = x.low <= x.high;
    const Vec origin = grid.origin_cell_center(origin_cell[c]) / smoothing_length;
    x_min[c] = used ? outwards(origin.x() + static_cast<double>(x.low), -1.0) : kHuge;
    x_max[c] = used ? outwards(origin.x() + static_cast<double>(x.high), 1.0) : -kHuge;
    y_min[c] = used ? outwards(origin.y() + static_cast<double>(y.low), -1.0) : kHuge;
    y_max[c] = used ? outwards(origin.y() + static_cast<double>(y.high), 1.0) : -kHuge;
  }
}

void ClusterBounds::assign_rows(ThreadTeam& team, const Layout& layout) {
  const std::size_t rows = layout.row_begin.size() - 1;
  row_y_min.resize(rows);
  row_y_max.resize(rows);
  team.run(rows, [&](std::size_t s) {
    const std::size_t begin = layout.row_begin[s];
    const std::size_t end = layout.row_begin[s + 1];
    // Written once: rows side by side share lines of the cache.
    float low = kHuge;
    float high = -kHuge;
    float right = -kHuge;
    for (std::size_t c = begin; c < end; ++c) {
      x_max_before[c] = right = std::max(right, x_max[c]);
      low = std::min(low, y_min[c]);
      high = std::max(high, y_max[c]);
    }
    row_y_min[s] = low;
    row_y_max[s] = high;
    float left = kHuge;
    for (std::size_t c = end; c-- > begin;) x_min_after[c] = left = std::min(left, x_min[c]);
  });
  row_y_max_before.resize(rows);
  row_y_min_after.resize(rows);
  std::inclusive_scan(row_y_max.begin(), row_y_max.end(), row_y_max_before.begin(),
                      [](float a, float b) { return std::max(a, b); });
  std::inclusive_scan(row_y_min.rbegin(), row_y_min.rend(), row_y_min_after.rbegin(),
                      [](float a, float b) { return std::min(a, b); });
}

std::size_t ClusterBounds::first_row(float y) const {
  const auto first = std::lower_bound(row_y_max_before.begin(), row_y_max_before.end(), y);
  return static_cast<std::size_t>(first - row_y_max_before.begin());
}

template <typename T>
void build_pair_lists(ThreadTeam& team, const Sweeps<T>& sweeps, const PairRange<T>& range,
                      std::span<const NewPairList<T>> lists) {
  std::size_t tasks = 0;
  for (const NewPairList<T>& one : lists) {
    one.list->chunks.resize(one.self->layout.chunks());
    tasks += one.list->chunks.size();
  }
  team.run(tasks, [&](std::size_t task) {
    auto wanted = lists.begin();
    for (; task >= wanted->list->chunks.size(); ++wanted) task -= wanted->list->chunks.size();
    build_chunk(sweeps, range, *wanted, task);
  });
}

template void ClusterBounds::assign_boxes<float>(std::size_t, std::size_t, const Grid&, double,
                                                 const ListPathsView<float>&);
template void ClusterBounds::assign_boxes<double>(std::size_t, std::size_t, const Grid&, double,
                                                  const ListPathsView<double>&);
template void build_pair_lists<float>(ThreadTeam&, const Sweeps<float>&, const PairRange<float>&,
                                      std::span<const NewPairList<float>>);
template void build_pair_lists<double>(ThreadTeam&, const Sweeps<double>&, const PairRange<double>&,
                                       std::span<const NewPairList<double>>);

}  // namespace sluice
