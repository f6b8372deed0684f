#include "engine/sph/layout.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sluice {
namespace {

constexpr double kMaxCells = 1 << 20;     // of one direction
constexpr double kSingleTile = 1024.0;    // smoothing lengths
constexpr double kTile = 512.0;           // smoothing lengths
constexpr std::size_t kBlock = 1024;      // particles or cells to a task
constexpr std::size_t kWholeVectors = 4;  // clusters: every target's loops end on a whole vector

// A large chunk has few neighbours in other chunks, all the fewer the more strips it spans; its
// sums should stay in the second cache, and several threads need several chunks: where their number
// is odd one of two threads gets one more, a tenth of the time where they are 11.
constexpr std::size_t kLeastChunks = 16;
constexpr std::size_t kManyChunks = 64;  // where chunks may grow beyond kChunk
constexpr std::size_t kLeastChunk = 32;  // clusters
constexpr std::size_t kChunk = 512;
constexpr std::size_t kMostChunk = 2560;

/// Clusters per chunk of so many clusters.
std::size_t chunk_of(std::size_t clusters) {
  const std::size_t share = (clusters + kLeastChunks - 1) / kLeastChunks;
  const std::size_t few = std::clamp(share, kLeastChunk, kChunk);
  const std::size_t many = std::min(clusters / kManyChunks, kMostChunk);
  return (std::max(few, many) + kWholeVectors - 1) / kWholeVectors * kWholeVectors;
}

}  // namespace

Grid::Grid(const Box& domain, double spacing, double smoothing_length, std::size_t particles) {
  strip_ = std::max(2.0 * spacing, domain.size().y() / kMaxCells);
  // A strip edge at y = 0 puts two whole rows of a lattice that starts there into each strip.
  origin_ = {domain.min.x(), std::floor(domain.min.y() / strip_) * strip_};
  strips_ = static_cast<std::size_t>((domain.max.y() - origin_.y()) / strip_) + 1;
  const double most_bins =
      std::max(1.0, static_cast<double>(8 * particles + 65536) / static_cast<double>(strips_));
  bin_ = std::max(2.0 * spacing, domain.size().x() / std::min(most_bins, kMaxCells));
  bins_ = static_cast<std::size_t>(domain.size().x() / bin_) + 1;
  max_cluster_length_ = std::max(6.0 * spacing, 3.0 * smoothing_length);

  const bool one_tile = domain.size().maxCoeff() <= kSingleTile * smoothing_length;
  tile_size_ = (one_tile ? 4.0 * kSingleTile : kTile) * smoothing_length;
  tile_origin_ = one_tile ? Vec((domain.min + domain.max) / 2.0 - Vec::Constant(tile_size_ / 2.0))
                          : domain.min;
}

std::size_t Grid::cell(double distance, double size, std::size_t count) {
  const double n = std::floor(distance / size);
  if (!(n > 0.0)) return 0;
  return std::min(static_cast<std::size_t>(std::min(n, kMaxCells * 4.0)), count - 1);
}

Grid::Tile Grid::tile(const Vec& position) const {
  // A place that is not a number is somewhere too.
  const auto index = [](double n) {
    return n > -1e6 ? static_cast<int>(std::floor(std::min(n, 1e6))) : -1'000'000;
  };
  const Vec n = (position - tile_origin_) / tile_size_;
  return {index(n.x()), index(n.y())};
}

Order sort_into_clusters(ThreadTeam& team, const Grid& grid, std::span<const double> x,
                         std::span<const double> y, std::span<const double> id,
                         std::span<const std::uint32_t> use) {
  // Counting sort by cell, then insertion sort by x inside it: linear.
  std::vector<std::uint32_t> cell(use.size());
  team.run((use.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    const std::size_t end = std::min(use.size(), kBlock * (block + 1));
    for (std::size_t k = kBlock * block; k < end; ++k) {
      const std::uint32_t p = use[k];
      cell[k] = static_cast<std::uint32_t>(grid.strip(y[p]) * grid.bins() + grid.bin(x[p]));
    }
  });
  std::vector<std::uint32_t> first(grid.strips() * grid.bins() + 1, 0);
  for (const std::uint32_t c : cell) ++first[c + 1];
  for (std::size_t c = 1; c < first.size(); ++c) first[c] += first[c - 1];

  std::vector<std::uint32_t> sorted(use.size());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < use.size(); ++k) sorted[next[cell[k]]++] = use[k];

  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    if (x[a] != x[b]) return x[a] < x[b];
    return std::tie(y[a], id[a]) < std::tie(y[b], id[b]);
  };
  const std::size_t cells = first.size() - 1;
  team.run((cells + kBlock - 1) / kBlock, [&](std::size_t block) {
    for (std::size_t c = kBlock * block; c < std::min(cells, kBlock * (block + 1)); ++c) {
      for (std::uint32_t k = first[c] + 1; k < first[c + 1]; ++k) {
        const std::uint32_t p = sorted[k];
        std::uint32_t place = k;
        for (; place > first[c] && before(p, sorted[place - 1]); --place) {
          sorted[place] = sorted[place - 1];
        }
        sorted[place] = p;
      }
    }
  });

  Order order;
  Layout& layout = order.layout;
  std::vector<std::uint32_t>& source = order.source;
  source.reserve(use.size() + use.size() / 8 + kCluster * (grid.strips() + kWholeVectors));
  layout.strip_begin.reserve(grid.strips() + 1);
  const auto fill_cluster = [&](std::size_t multiple) {
    while (source.size() % multiple != 0) source.push_back(Order::kEmpty);
  };
  for (std::size_t strip = 0; strip < grid.strips(); ++strip) {
    layout.strip_begin.push_back(static_cast<std::uint32_t>(source.size() / kCluster));
    double cluster_start = 0.0;
    for (std::size_t k = first[strip * grid.bins()]; k < first[(strip + 1) * grid.bins()]; ++k) {
      const std::uint32_t p = sorted[k];
      if (x[p] - cluster_start > grid.max_cluster_length()) fill_cluster(kCluster);
      if (source.size() % kCluster == 0) cluster_start = x[p];
      source.push_back(p);
    }
    fill_cluster(kCluster);
  }
  layout.strip_begin.push_back(static_cast<std::uint32_t>(source.size() / kCluster));
  fill_cluster(kCluster * kWholeVectors);
  layout.slot_count = source.size();
  layout.chunk = chunk_of(layout.clusters());
  return order;
}

}  // namespace sluice
