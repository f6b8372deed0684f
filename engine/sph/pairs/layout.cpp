#include "engine/sph/pairs/layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace sluice {
namespace {

constexpr double kMaxCells = 1 << 20;   // of one direction
constexpr double kSingleTile = 1024.0;  // smoothing lengths
constexpr double kTile = 512.0;         // smoothing lengths
constexpr std::size_t kPart = 1024;     // least slots to a part that is counted by itself
constexpr std::size_t kMostParts = 64;
constexpr std::size_t kStrips = 4;        // to a task
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

template <class Body>
void for_strips(ThreadTeam& team, const Grid& grid, const Body& body) {
  team.run((grid.strips() + kStrips - 1) / kStrips, [&](std::size_t task) {
    const std::size_t end = std::min(grid.strips(), kStrips * (task + 1));
    for (std::size_t strip = kStrips * task; strip < end; ++strip) body(strip);
  });
}

/// The particles of each strip, in the order of the input.
struct StripLists {
  std::vector<std::uint32_t> begin;      ///< of each strip, and the end
  std::vector<std::uint32_t> particles;  ///< indices

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t strip) const {
    return {particles.data() + begin[strip], particles.data() + begin[strip + 1]};
  }
};

StripLists particles_of_strips(ThreadTeam& team, const Grid& grid, std::span<const double> y,
                               std::span<const double> id) {
  // A part counts all strips, and so they may be no more than a few for each particle.
  const std::size_t parts = std::clamp<std::size_t>(
      std::min(id.size() / kPart, 8 * id.size() / grid.strips()), 1, kMostParts);
  // A counting sort by strip, part by part: where each part puts its next particle of a strip.
  std::vector<std::vector<std::uint32_t>> next(parts);
  std::vector<std::uint32_t> strip_of(id.size());
  const auto for_particles = [&](std::size_t part, const auto& body) {
    const std::size_t end = id.size() * (part + 1) / parts;
    for (std::size_t p = id.size() * part / parts; p < end; ++p) {
      if (id[p] >= 0.0) body(p);
    }
  };
  team.run(parts, [&](std::size_t part) {
    next[part].assign(grid.strips(), 0);
    for_particles(part, [&](std::size_t p) {
      strip_of[p] = static_cast<std::uint32_t>(grid.strip(y[p]));
      ++next[part][strip_of[p]];
    });
  });
  StripLists lists;
  lists.begin.reserve(grid.strips() + 1);
  std::uint32_t count = 0;
  for (std::size_t strip = 0; strip < grid.strips(); ++strip) {
    lists.begin.push_back(count);
    for (std::vector<std::uint32_t>& of_part : next) {
      count += std::exchange(of_part[strip], count);
    }
  }
  lists.begin.push_back(count);
  lists.particles.resize(count);
  team.run(parts, [&](std::size_t part) {
    for_particles(part, [&](std::size_t p) {
      lists.particles[next[part][strip_of[p]]++] = static_cast<std::uint32_t>(p);
    });
  });
  return lists;
}

/// The particles of a strip by (x, y, id): a counting sort by bin, then an insertion sort. Linear
/// while a bin holds a few, or what it holds comes nearly sorted.
void sort_strip(const Grid& grid, std::span<const double> x, std::span<const double> y,
                std::span<const double> id, std::span<const std::uint32_t> particles,
                std::span<std::uint32_t> sorted) {
  if (particles.empty()) return;
  thread_local std::vector<std::uint32_t> next;  // of each bin
  next.assign(grid.bins() + 1, 0);
  for (const std::uint32_t p : particles) ++next[grid.bin(x[p]) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (const std::uint32_t p : particles) sorted[next[grid.bin(x[p])]++] = p;

  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    if (x[a] != x[b]) return x[a] < x[b];
    return std::tie(y[a], id[a]) < std::tie(y[b], id[b]);
  };
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    const std::uint32_t p = sorted[k];
    std::size_t place = k;
    for (; place > 0 && before(p, sorted[place - 1]); --place) sorted[place] = sorted[place - 1];
    sorted[place] = p;
  }
}

/// Calls put(slot, particle) for the sorted particles of a strip, slots counted from the strip's
/// first. Returns how many slots the strip takes, whole clusters.
template <class Put>
std::uint32_t walk_clusters(const Grid& grid, std::span<const double> x,
                            std::span<const std::uint32_t> sorted, const Put& put) {
  constexpr auto kSlots = static_cast<std::uint32_t>(kCluster);
  std::uint32_t slot = 0;
  double cluster_start = 0.0;
  for (const std::uint32_t p : sorted) {
    const std::uint32_t used = slot % kSlots;
    if (used != 0 && x[p] - cluster_start > grid.max_cluster_length()) slot += kSlots - used;
    if (slot % kSlots == 0) cluster_start = x[p];
    put(slot++, p);
  }
  return (slot + kSlots - 1) / kSlots * kSlots;
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

  one_tile_ = domain.size().maxCoeff() <= kSingleTile * smoothing_length;
  tile_size_ = (one_tile_ ? 4.0 * kSingleTile : kTile) * smoothing_length;
  tile_origin_ = one_tile_ ? Vec((domain.min + domain.max) / 2.0 - Vec::Constant(tile_size_ / 2.0))
                           : domain.min;
}

std::size_t Grid::cell(double distance, double size, std::size_t count) {
  const double n = distance / size;
  if (!(n >= 1.0)) return 0;
  return std::min(static_cast<std::size_t>(std::min(n, kMaxCells * 4.0)), count - 1);
}

Grid::Tile Grid::tile(const Vec& position) const {
  if (one_tile_) return {};
  // A place that is not a number is somewhere too.
  const auto index = [](double n) {
    return n > -1e6 ? static_cast<int>(std::floor(std::min(n, 1e6))) : -1'000'000;
  };
  const Vec n = (position - tile_origin_) / tile_size_;
  return {index(n.x()), index(n.y())};
}

Order sort_into_clusters(ThreadTeam& team, const Grid& grid, std::span<const double> x,
                         std::span<const double> y, std::span<const double> id) {
  const StripLists strips = particles_of_strips(team, grid, y, id);
  std::vector<std::uint32_t> sorted(strips.particles.size());
  std::vector<std::uint32_t> slots(grid.strips() + 1, 0);  // of each strip, then their first
  const auto sorted_of = [&](std::size_t strip) {
    return std::span(sorted.data() + strips.begin[strip], sorted.data() + strips.begin[strip + 1]);
  };
  for_strips(team, grid, [&](std::size_t strip) {
    sort_strip(grid, x, y, id, strips.of(strip), sorted_of(strip));
    slots[strip + 1] =
        walk_clusters(grid, x, sorted_of(strip), [](std::uint32_t, std::uint32_t) {});
  });
  std::partial_sum(slots.begin(), slots.end(), slots.begin());

  Order order;
  Layout& layout = order.layout;
  for (const std::uint32_t slot : slots) {
    layout.strip_begin.push_back(slot / static_cast<std::uint32_t>(kCluster));
  }
  constexpr std::size_t kWhole = kCluster * kWholeVectors;
  layout.slot_count = (slots.back() + kWhole - 1) / kWhole * kWhole;
  layout.chunk = chunk_of(layout.clusters());
  order.source.assign(layout.slot_count, Order::kEmpty);
  for_strips(team, grid, [&](std::size_t strip) {
    std::uint32_t* const source = order.source.data() + slots[strip];
    walk_clusters(grid, x, sorted_of(strip),
                  [&](std::uint32_t slot, std::uint32_t particle) { source[slot] = particle; });
  });
  return order;
}

}  // namespace sluice
