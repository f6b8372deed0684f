#include "engine/sph/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sluice {
namespace {

// Of sums of bounds and reaches; the bounds themselves are rounded outwards.
constexpr float kSlack = 1e-3F;

/// Two steps of single precision farther: the value's own rounding, and that of a sum with it.
float outwards(float value, float towards) {
  return std::nextafter(std::nextafter(value, towards), towards);
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
  void start(float low, float high, float margin) {
    rows_.clear();
    const std::size_t strips = layout_.strip_begin.size() - 1;
    for (std::size_t s = 0; s < strips; ++s) {
      const std::uint32_t begin = layout_.strip_begin[s];
      const std::uint32_t end = layout_.strip_begin[s + 1];
      if (begin == end) continue;
      const float reach = margin + bounds_.strip_reach[s] + kSlack;
      if (bounds_.strip_y_max[s] < low - reach || bounds_.strip_y_min[s] > high + reach) continue;
      rows_.push_back({begin, end, reach});
    }
  }

  /// Appends the entries for a cluster with bounds [x_min, x_max]; x_min must not fall within a
  /// strip.
  void collect(float x_min, float x_max, float y_min, float y_max, const Grid::Tile& tile,
               std::vector<std::uint32_t>& out) {
    for (Row& row : rows_) {
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

}  // namespace

void ClusterBounds::assign(const Grid& grid, const Layout& layout, double smoothing_length,
                           const double* x, const double* y, const double* reach_of,
                           const double* id) {
  constexpr float kHuge = std::numeric_limits<float>::max();
  const std::size_t clusters = layout.clusters();
  for (auto* a : {&x_min, &y_min}) a->assign(clusters, kHuge);
  for (auto* a : {&x_max, &y_max}) a->assign(clusters, -kHuge);
  reach.assign(clusters, 0.0F);
  tile.assign(clusters, {});
  for (std::size_t c = 0; c < clusters; ++c) {
    for (std::size_t s = kCluster * c; s < kCluster * (c + 1) && id[s] >= 0.0; ++s) {
      if (s == kCluster * c) tile[c] = grid.tile({x[s], y[s]});
      const auto xs = static_cast<float>(x[s] / smoothing_length);
      const auto ys = static_cast<float>(y[s] / smoothing_length);
      x_min[c] = std::min(x_min[c], outwards(xs, -kHuge));
      x_max[c] = std::max(x_max[c], outwards(xs, kHuge));
      y_min[c] = std::min(y_min[c], outwards(ys, -kHuge));
      y_max[c] = std::max(y_max[c], outwards(ys, kHuge));
      reach[c] = std::max(reach[c], static_cast<float>(reach_of[s] / smoothing_length));
    }
  }
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
void build_pair_list(ThreadTeam& team, const Sweeps<T>& sweeps, T cut_off, T tile_size,
                     const Layout& self_layout, const ClusterBounds& self_bounds,
                     const PairView<T>& self, const Layout& other_layout,
                     const ClusterBounds& other_bounds, const PairView<T>& other, PairList& list) {
  const std::size_t clusters = self_layout.clusters();
  const std::size_t chunks = (clusters + kChunk - 1) / kChunk;
  list.chunks.resize(chunks);
  team.run(chunks, [&](std::size_t task) {
    PairList::Chunk& chunk = list.chunks[task];
    const std::size_t first = task * kChunk;
    const std::size_t count = std::min(kChunk, clusters - first);
    chunk.entries.clear();
    chunk.begin.assign(count + 1, 0);

    std::vector<std::uint32_t> candidates;
    StripSearch search(other_layout, other_bounds);
    const auto& strips = self_layout.strip_begin;
    auto strip_end = strips.begin();  // end of the strip of the last cluster
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t c = first + n;
      chunk.begin[n + 1] = chunk.begin[n];
      if (c >= strips.back()) continue;  // padding behind the last strip
      if (n == 0 || c >= *strip_end) {
        strip_end = std::upper_bound(strips.begin(), strips.end(), static_cast<std::uint32_t>(c));
        const auto s = static_cast<std::size_t>(strip_end - strips.begin()) - 1;
        search.start(self_bounds.strip_y_min[s], self_bounds.strip_y_max[s],
                     static_cast<float>(cut_off) + self_bounds.strip_reach[s]);
      }
      candidates.clear();
      search.collect(self_bounds.x_min[c], self_bounds.x_max[c], self_bounds.y_min[c],
                     self_bounds.y_max[c], self_bounds.tile[c], candidates);
      chunk.entries.resize(chunk.begin[n] + candidates.size());
      const std::size_t kept =
          sweeps.prune({self, other, cut_off, tile_size, c, candidates.data(), candidates.size(),
                        chunk.entries.data() + chunk.begin[n]});
      chunk.begin[n + 1] = chunk.begin[n] + static_cast<std::uint32_t>(kept);
      chunk.entries.resize(chunk.begin[n + 1]);
    }
  });
}

template void build_pair_list<float>(ThreadTeam&, const Sweeps<float>&, float, float, const Layout&,
                                     const ClusterBounds&, const PairView<float>&, const Layout&,
                                     const ClusterBounds&, const PairView<float>&, PairList&);
template void build_pair_list<double>(ThreadTeam&, const Sweeps<double>&, double, double,
                                      const Layout&, const ClusterBounds&, const PairView<double>&,
                                      const Layout&, const ClusterBounds&, const PairView<double>&,
                                      PairList&);

}  // namespace sluice
