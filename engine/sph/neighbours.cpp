#include "engine/sph/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sluice {
namespace {

// Of differences of bounds; the bounds themselves are rounded outwards.
constexpr float kSlack = 1e-3F;

std::uint32_t tile_code(const Grid::Tile& i, const Grid::Tile& j) {
  const int column = std::clamp(j.column - i.column, -1, 1) + 1;
  const int row = std::clamp(j.row - i.row, -1, 1) + 1;
  return static_cast<std::uint32_t>(row * 3 + column);
}

/// Walks the clusters of `other` beside those of one strip of `self`, left to right.
class StripSearch {
 public:
  StripSearch(const Layout& layout, const ClusterBounds& bounds, float cut_off)
      : layout_(layout), bounds_(bounds), range_(cut_off + kSlack) {}

  /// Starts at a new strip of `self`, within [low, high]. Strips of `other` before `first_strip`
  /// are left out.
  void start(float low, float high, std::size_t first_strip) {
    rows_.clear();
    const std::size_t strips = layout_.strip_begin.size() - 1;
    for (std::size_t s = std::max(first_strip, bounds_.first_strip(low - range_));
         s < strips && bounds_.strip_y_min_after[s] <= high + range_; ++s) {
      const std::uint32_t begin = layout_.strip_begin[s];
      const std::uint32_t end = layout_.strip_begin[s + 1];
      if (bounds_.strip_y_max[s] < low - range_ || bounds_.strip_y_min[s] > high + range_) continue;
      rows_.push_back({begin, end});
    }
  }

  /// Fills `out` with the entries for cluster `i` of `self`; later clusters of its strip begin no
  /// farther left than self.x_min_after[i]. Clusters of `other` before `first` are left out.
  /// Returns how many they are; `out` may be longer.
  std::size_t collect(const ClusterBounds& self, std::size_t i, std::size_t first,
                      std::vector<std::uint32_t>& out) {
    std::size_t found = 0;
    const float left = self.x_min[i] - range_;
    const float right = self.x_max[i] + range_;
    const float low = self.y_min[i] - range_;
    const float high = self.y_max[i] + range_;
    const float passed = self.x_min_after[i] - range_;
    for (Row& row : rows_) {
      row.next = std::max(row.next, static_cast<std::uint32_t>(first));
      while (row.next < row.end && bounds_.x_max_before[row.next] < passed) ++row.next;
      // Room first, so that no entry waits for a branch.
      std::uint32_t last = row.next;
      while (last < row.end && bounds_.x_min_after[last] <= right) ++last;
      if (out.size() < found + (last - row.next)) out.resize(2 * (found + (last - row.next)));
      for (std::uint32_t j = row.next; j < last; ++j) {
        out[found] = j | tile_code(self.tile[i], bounds_.tile[j]) << PairList::kShiftBit;
        const unsigned near_x =
            unsigned{bounds_.x_max[j] >= left} & unsigned{bounds_.x_min[j] <= right};
        const unsigned near_y =
            unsigned{bounds_.y_max[j] >= low} & unsigned{bounds_.y_min[j] <= high};
        found += near_x & near_y;
      }
    }
    return found;
  }

 private:
  struct Row {
    std::uint32_t next;
    std::uint32_t end;
  };
  const Layout& layout_;
  const ClusterBounds& bounds_;
  float range_;
  std::vector<Row> rows_;
};

/// Gives every entry of a mutual list its place in the chunk's sums.
void assign_places(std::size_t first, std::size_t count, std::size_t clusters,
                   PairList::Chunk& chunk) {
  constexpr std::uint32_t kNone = ~0U;
  // Of every cluster; all kNone between calls, so that only the guests are reset.
  thread_local std::vector<std::uint32_t> place;
  if (place.size() < clusters) place.assign(clusters, kNone);
  resize_closely(chunk.targets, chunk.entries.size());
  chunk.guests.clear();
  for (std::size_t e = 0; e < chunk.entries.size(); ++e) {
    const std::uint32_t j = chunk.entries[e] & PairList::kClusterMask;
    if (j < first + count) {
      chunk.targets[e] = j - static_cast<std::uint32_t>(first);
      continue;
    }
    if (place[j] == kNone) {
      place[j] = static_cast<std::uint32_t>(count + chunk.guests.size());
      chunk.guests.push_back(j);
    }
    chunk.targets[e] = place[j];
  }
  for (const std::uint32_t j : chunk.guests) place[j] = kNone;
  // A cluster with itself gets all its pairs from its own side.
  const auto nobody = static_cast<std::uint32_t>(chunk.places() - 1);
  for (std::size_t n = 0; n < count; ++n) {
    if (chunk.begin[n] != chunk.begin[n + 1]) chunk.targets[chunk.begin[n]] = nobody;
  }
}

constexpr float kHuge = std::numeric_limits<float>::max();

/// A box that is still empty, in smoothing lengths.
struct Extent {
  double low = std::numeric_limits<double>::max();
  double high = -std::numeric_limits<double>::max();
  void add(double from, double way, double leeway) {
    low = std::min(low, from + std::min(way, 0.0) - leeway);
    high = std::max(high, from + std::max(way, 0.0) + leeway);
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
  thread_local std::vector<std::uint32_t> entries;
  std::vector<std::uint32_t> candidates;
  StripSearch search(other.layout, other.bounds, static_cast<float>(range.cut_off));
  const ClusterBounds& bounds = self.bounds;
  const auto& strips = self.layout.strip_begin;
  auto strip_end = strips.begin();  // end of the strip of the last cluster
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t c = first + n;
    chunk.begin[n + 1] = chunk.begin[n];
    if (c >= strips.back() || bounds.x_min[c] > bounds.x_max[c]) continue;  // empty
    if (strip_end == strips.begin() || c >= *strip_end) {
      strip_end = std::upper_bound(strips.begin(), strips.end(), static_cast<std::uint32_t>(c));
      const auto s = static_cast<std::size_t>(strip_end - strips.begin()) - 1;
      search.start(bounds.strip_y_min[s], bounds.strip_y_max[s], mutual ? s : 0);
    }
    const std::size_t found = search.collect(bounds, c, mutual ? c : 0, candidates);
    if (entries.size() < chunk.begin[n] + found) entries.resize(2 * (chunk.begin[n] + found));
    const std::size_t kept =
        sweeps.prune({self.tracks, other.tracks, range.leeway, range.cut_off, range.tile_size, c,
                      candidates.data(), found, entries.data() + chunk.begin[n]});
    chunk.begin[n + 1] = chunk.begin[n] + static_cast<std::uint32_t>(kept);
  }
  resize_closely(chunk.entries, chunk.begin.back());
  std::copy_n(entries.begin(), chunk.begin.back(), chunk.entries.begin());
  if (mutual) assign_places(first, count, self.layout.clusters(), chunk);
}

}  // namespace

float outwards(double value, double towards) {
  constexpr double kRounding = 2.0 * std::numeric_limits<float>::epsilon();
  return static_cast<float>(value + towards * kRounding * std::abs(value));
}

void ClusterBounds::assign_tiles(ThreadTeam& team, const Grid& grid, const Layout& layout,
                                 const double* x, const double* y, const double* id) {
  const std::size_t clusters = layout.clusters();
  resize_closely(tile, clusters);
  team.run(layout.chunks(), [&](std::size_t chunk) {
    for (std::size_t c = layout.chunk_begin(chunk); c < layout.chunk_begin(chunk + 1); ++c) {
      const std::size_t first = kCluster * c;
      tile[c] = id[first] < 0.0 ? Grid::Tile{} : grid.tile({x[first], y[first]});
    }
  });
}

void ClusterBounds::assign_boxes(ThreadTeam& team, const Layout& layout, const Method& method,
                                 const Leeway<double>& leeway, const Places& places) {
  const std::size_t clusters = layout.clusters();
  for (auto* a : {&x_min, &x_max, &y_min, &y_max, &x_max_before, &x_min_after}) {
    resize_closely(*a, clusters);
  }
  const std::size_t strips = layout.strip_begin.size() - 1;
  strip_y_min.assign(strips, kHuge);
  strip_y_max.assign(strips, -kHuge);
  const double per_h = 1.0 / method.smoothing_length;
  const double per_c = 1.0 / method.sound_speed;
  const auto box = [&](std::size_t c) {
    Extent x;
    Extent y;
    for (std::size_t s = kCluster * c; s < kCluster * (c + 1) && places.id[s] >= 0.0; ++s) {
      const double u = places.vx != nullptr ? track_speed(places.vx[s] * per_c) : 0.0;
      const double v = places.vy != nullptr ? track_speed(places.vy[s] * per_c) : 0.0;
      const double off = leeway.least + leeway.per_speed * (std::abs(u) + std::abs(v));
      x.add(places.x[s] * per_h, leeway.lifetime * u, off);
      y.add(places.y[s] * per_h, leeway.lifetime * v, off);
    }
    const bool used = places.id[kCluster * c] >= 0.0;
    x_min[c] = used ? outwards(x.low, -1.0) : kHuge;
    x_max[c] = used ? outwards(x.high, 1.0) : -kHuge;
    y_min[c] = used ? outwards(y.low, -1.0) : kHuge;
    y_max[c] = used ? outwards(y.high, 1.0) : -kHuge;
  };
  team.run(layout.chunks(), [&](std::size_t chunk) {
    for (std::size_t c = layout.chunk_begin(chunk); c < layout.chunk_begin(chunk + 1); ++c) box(c);
  });
  team.run(strips, [&](std::size_t s) {
    const std::size_t begin = layout.strip_begin[s];
    const std::size_t end = layout.strip_begin[s + 1];
    float right = -kHuge;
    for (std::size_t c = begin; c < end; ++c) {
      x_max_before[c] = right = std::max(right, x_max[c]);
      strip_y_min[s] = std::min(strip_y_min[s], y_min[c]);
      strip_y_max[s] = std::max(strip_y_max[s], y_max[c]);
    }
    float left = kHuge;
    for (std::size_t c = end; c-- > begin;) x_min_after[c] = left = std::min(left, x_min[c]);
  });
  strip_y_max_before.resize(strips);
  strip_y_min_after.resize(strips);
  std::inclusive_scan(strip_y_max.begin(), strip_y_max.end(), strip_y_max_before.begin(),
                      [](float a, float b) { return std::max(a, b); });
  std::inclusive_scan(strip_y_min.rbegin(), strip_y_min.rend(), strip_y_min_after.rbegin(),
                      [](float a, float b) { return std::min(a, b); });
}

std::size_t ClusterBounds::first_strip(float y) const {
  const auto first = std::lower_bound(strip_y_max_before.begin(), strip_y_max_before.end(), y);
  return static_cast<std::size_t>(first - strip_y_max_before.begin());
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

template void build_pair_lists<float>(ThreadTeam&, const Sweeps<float>&, const PairRange<float>&,
                                      std::span<const NewPairList<float>>);
template void build_pair_lists<double>(ThreadTeam&, const Sweeps<double>&, const PairRange<double>&,
                                       std::span<const NewPairList<double>>);

}  // namespace sluice
