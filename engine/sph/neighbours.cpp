#include "engine/sph/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sluice {
namespace {

// Of sums of bounds and reaches; the bounds themselves are rounded outwards.
constexpr float kSlack = 1e-3F;

/// In single precision and two steps farther: the value's own rounding, and that of a sum with it.
float outwards(double value, float towards) {
  return std::nextafter(std::nextafter(static_cast<float>(value), towards), towards);
}

std::uint32_t tile_code(const Grid::Tile& i, const Grid::Tile& j) {
  const int column = std::clamp(j.column - i.column, -1, 1) + 1;
  const int row = std::clamp(j.row - i.row, -1, 1) + 1;
  return static_cast<std::uint32_t>(row * 3 + column);
}

/// Walks the clusters of `other` beside those of one strip of `self`, left to right.
class StripSearch {
 public:
  StripSearch(const Layout& layout, const ClusterBounds& bounds)
      : layout_(layout), bounds_(bounds) {}

  /// Starts at a new strip of `self`: none of its clusters reaches out of [low, high] + margin.
  /// Strips of `other` before `first_strip` are left out.
  void start(float low, float high, float margin, std::size_t first_strip) {
    rows_.clear();
    const std::size_t strips = layout_.strip_begin.size() - 1;
    for (std::size_t s = first_strip; s < strips; ++s) {
      const std::uint32_t begin = layout_.strip_begin[s];
      const std::uint32_t end = layout_.strip_begin[s + 1];
      if (begin == end) continue;
      const float reach = margin + bounds_.strip_reach[s] + kSlack;
      if (bounds_.strip_y_max[s] < low - reach || bounds_.strip_y_min[s] > high + reach) continue;
      rows_.push_back({begin, end, reach});
    }
  }

  /// Appends the entries for a cluster with bounds [x_min, x_max]; x_min must not fall within a
  /// strip. Clusters of `other` before `first` are left out.
  void collect(float x_min, float x_max, float y_min, float y_max, const Grid::Tile& tile,
               std::size_t first, std::vector<std::uint32_t>& out) {
    for (Row& row : rows_) {
      row.next = std::max(row.next, static_cast<std::uint32_t>(first));
      while (row.next < row.end && bounds_.x_max[row.next] < x_min - row.reach) ++row.next;
      for (std::uint32_t j = row.next; j < row.end && bounds_.x_min[j] <= x_max + row.reach; ++j) {
        if (bounds_.y_min[j] > y_max + row.reach || bounds_.y_max[j] < y_min - row.reach) continue;
        out.push_back(j | tile_code(tile, bounds_.tile[j]) << PairList::kShiftBit);
      }
    }
  }

 private:
  struct Row {
    std::uint32_t next;
    std::uint32_t end;
    float reach;
  };
  const Layout& layout_;
  const ClusterBounds& bounds_;
  std::vector<Row> rows_;
};

/// Gives every entry of a mutual list its place in the chunk's sums.
void assign_places(std::size_t first, std::size_t count, std::size_t clusters,
                   PairList::Chunk& chunk) {
  constexpr std::uint32_t kNone = ~0U;
  // Of every cluster; all kNone between calls, so that only the guests are reset.
  thread_local std::vector<std::uint32_t> place;
  if (place.size() < clusters) place.assign(clusters, kNone);
  chunk.targets.resize(chunk.entries.size());
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

}  // namespace

void ClusterBounds::assign(ThreadTeam& team, const Grid& grid, const Layout& layout,
                           double smoothing_length, const double* x, const double* y,
                           const double* reach_of, const double* id) {
  constexpr float kHuge = std::numeric_limits<float>::max();
  const std::size_t clusters = layout.clusters();
  for (auto* a : {&x_min, &x_max, &y_min, &y_max, &reach}) a->resize(clusters);
  tile.resize(clusters);
  const auto bound = [&](std::size_t c) {
    const std::size_t first = kCluster * c;
    if (id[first] < 0.0) {
      x_min[c] = y_min[c] = kHuge;
      x_max[c] = y_max[c] = -kHuge;
      reach[c] = 0.0F;
      tile[c] = {};
      return;
    }
    double left = x[first], right = left, bottom = y[first], top = bottom, most = reach_of[first];
    for (std::size_t s = first + 1; s < first + kCluster && id[s] >= 0.0; ++s) {
      left = std::min(left, x[s]);
      right = std::max(right, x[s]);
      bottom = std::min(bottom, y[s]);
      top = std::max(top, y[s]);
      most = std::max(most, reach_of[s]);
    }
    tile[c] = grid.tile({x[first], y[first]});
    x_min[c] = outwards(left / smoothing_length, -kHuge);
    x_max[c] = outwards(right / smoothing_length, kHuge);
    y_min[c] = outwards(bottom / smoothing_length, -kHuge);
    y_max[c] = outwards(top / smoothing_length, kHuge);
    reach[c] = static_cast<float>(most / smoothing_length);
  };
  team.run((clusters + kChunk - 1) / kChunk, [&](std::size_t task) {
    for (std::size_t c = kChunk * task; c < std::min(clusters, kChunk * (task + 1)); ++c) bound(c);
  });
  const std::size_t strips = layout.strip_begin.size() - 1;
  strip_y_min.assign(strips, kHuge);
  strip_y_max.assign(strips, -kHuge);
  strip_reach.assign(strips, 0.0F);
  for (std::size_t s = 0; s < strips; ++s) {
    for (std::uint32_t c = layout.strip_begin[s]; c < layout.strip_begin[s + 1]; ++c) {
      strip_y_min[s] = std::min(strip_y_min[s], y_min[c]);
      strip_y_max[s] = std::max(strip_y_max[s], y_max[c]);
      strip_reach[s] = std::max(strip_reach[s], reach[c]);
    }
  }
}

template <typename T>
void build_pair_list(ThreadTeam& team, const Sweeps<T>& sweeps, const PairRange<T>& range,
                     const PairSet<T>& self, const PairSet<T>& other, PairList& list) {
  const bool mutual = &self == &other;
  const std::size_t clusters = self.layout.clusters();
  const std::size_t chunks = (clusters + kChunk - 1) / kChunk;
  list.chunks.resize(chunks);
  team.run(chunks, [&](std::size_t task) {
    PairList::Chunk& chunk = list.chunks[task];
    const std::size_t first = task * kChunk;
    const std::size_t count = std::min(kChunk, clusters - first);
    chunk.entries.clear();
    chunk.begin.assign(count + 1, 0);

    std::vector<std::uint32_t> candidates;
    StripSearch search(other.layout, other.bounds);
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
        search.start(bounds.strip_y_min[s], bounds.strip_y_max[s],
                     static_cast<float>(range.cut_off) + bounds.strip_reach[s], mutual ? s : 0);
      }
      candidates.clear();
      search.collect(bounds.x_min[c], bounds.x_max[c], bounds.y_min[c], bounds.y_max[c],
                     bounds.tile[c], mutual ? c : 0, candidates);
      chunk.entries.resize(chunk.begin[n] + candidates.size());
      const std::size_t kept = sweeps.prune(
          {self.pairs, other.pairs, range.cut_off, range.tile_size, c, candidates.data(),
           candidates.size(), chunk.entries.data() + chunk.begin[n]});
      chunk.begin[n + 1] = chunk.begin[n] + static_cast<std::uint32_t>(kept);
      chunk.entries.resize(chunk.begin[n + 1]);
    }
    if (mutual) assign_places(first, count, clusters, chunk);
  });
}

template void build_pair_list<float>(ThreadTeam&, const Sweeps<float>&, const PairRange<float>&,
                                     const PairSet<float>&, const PairSet<float>&, PairList&);
template void build_pair_list<double>(ThreadTeam&, const Sweeps<double>&, const PairRange<double>&,
                                      const PairSet<double>&, const PairSet<double>&, PairList&);

}  // namespace sluice
