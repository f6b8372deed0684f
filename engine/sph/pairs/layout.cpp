#include "engine/sph/pairs/layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace sluice {
namespace {

constexpr double kMaxCells = 1 << 20;         // of one direction
constexpr double kSingleOriginCell = 1024.0;  // smoothing lengths
constexpr double kOriginCell = 512.0;         // smoothing lengths
constexpr std::size_t kPart = 1024;           // least slots to a part that is counted by itself
constexpr std::size_t kMostParts = 64;
constexpr std::size_t kRows = 4;          // to a task
constexpr std::size_t kWholeVectors = 4;  // clusters: every target's loops end on a whole vector

// A large chunk has few neighbours in other chunks, all the fewer the more rows it spans; its
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
void for_rows(ThreadTeam& team, const Grid& grid, const Body& body) {
  team.run((grid.rows() + kRows - 1) / kRows, [&](std::size_t task) {
    const std::size_t end = std::min(grid.rows(), kRows * (task + 1));
    for (std::size_t row = kRows * task; row < end; ++row) body(row);
  });
}

/// The particles of each row, in the order of the input.
struct RowLists {
  std::vector<std::uint32_t> begin;      ///< of each row, and the end
  std::vector<std::uint32_t> particles;  ///< indices

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t row) const {
    return {particles.data() + begin[row], particles.data() + begin[row + 1]};
  }
};

RowLists particles_of_rows(ThreadTeam& team, const Grid& grid, std::span<const double> y,
                           std::span<const double> id) {
  // A part counts all rows, and so they may be no more than a few for each particle.
  const std::size_t parts = std::clamp<std::size_t>(
      std::min(id.size() / kPart, 8 * id.size() / grid.rows()), 1, kMostParts);
  // A counting sort by row, part by part: where each part puts its next particle of a row.
  std::vector<std::vector<std::uint32_t>> next(parts);
  std::vector<std::uint32_t> row_of(id.size());
  const auto for_particles = [&](std::size_t part, const auto& body) {
    const std::size_t end = id.size() * (part + 1) / parts;
    for (std::size_t p = id.size() * part / parts; p < end; ++p) {
      if (id[p] >= 0.0) body(p);
    }
  };
  team.run(parts, [&](std::size_t part) {
    next[part].assign(grid.rows(), 0);
    for_particles(part, [&](std::size_t p) {
      row_of[p] = static_cast<std::uint32_t>(grid.row(y[p]));
      ++next[part][row_of[p]];
    });
  });
  RowLists lists;
  lists.begin.reserve(grid.rows() + 1);
  std::uint32_t count = 0;
  for (std::size_t row = 0; row < grid.rows(); ++row) {
    lists.begin.push_back(count);
    for (std::vector<std::uint32_t>& of_part : next) {
      count += std::exchange(of_part[row], count);
    }
  }
  lists.begin.push_back(count);
  lists.particles.resize(count);
  team.run(parts, [&](std::size_t part) {
    for_particles(part, [&](std::size_t p) {
      lists.particles[next[part][row_of[p]]++] = static_cast<std::uint32_t>(p);
    });
  });
  return lists;
}

/// The particles of a row by (x, y, id): a counting sort by cell, then an insertion sort. Linear
/// while a cell holds a few, or what it holds comes nearly sorted.
void sort_row(const Grid& grid, std::span<const double> x, std::span<const double> y,
              std::span<const double> id, std::span<const std::uint32_t> particles,
              std::span<std::uint32_t> sorted) {
  if (particles.empty()) return;
  thread_local std::vector<std::uint32_t> next;  // of each cell
  next.assign(grid.cells() + 1, 0);
  for (const std::uint32_t p : particles) ++next[grid.cell(x[p]) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (const std::uint32_t p : particles) sorted[next[grid.cell(x[p])]++] = p;

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

/// Calls put(slot, particle) for the sorted particles of a row, slots counted from the row's
/// first. Returns how many slots the row takes, whole clusters.
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
  row_ = std::max(2.0 * spacing, domain.size().y() / kMaxCells);
  // A row edge at y = 0 puts two whole rows of a lattice that starts there into each row.
  origin_ = {domain.min.x(), std::floor(domain.min.y() / row_) * row_};
  rows_ = static_cast<std::size_t>((domain.max.y() - origin_.y()) / row_) + 1;
  const double most_cells =
      std::max(1.0, static_cast<double>(8 * particles + 65536) / static_cast<double>(rows_));
  cell_ = std::max(2.0 * spacing, domain.size().x() / std::min(most_cells, kMaxCells));
  cells_ = static_cast<std::size_t>(domain.size().x() / cell_) + 1;
  max_cluster_length_ = std::max(6.0 * spacing, 3.0 * smoothing_length);

  one_origin_cell_ = domain.size().maxCoeff() <= kSingleOriginCell * smoothing_length;
  origin_cell_size_ = (one_origin_cell_ ? 4.0 * kSingleOriginCell : kOriginCell) * smoothing_length;
  origin_cell_corner_ =
      one_origin_cell_
          ? Vec((domain.min + domain.max) / 2.0 - Vec::Constant(origin_cell_size_ / 2.0))
          : domain.min;
}

std::size_t Grid::index_of(double distance, double size, std::size_t count) {
  const double n = distance / size;
  if (!(n >= 1.0)) return 0;
  return std::min(static_cast<std::size_t>(std::min(n, kMaxCells * 4.0)), count - 1);
}

Grid::OriginCell Grid::origin_cell(const Vec& position) const {
  if (one_origin_cell_) return {};
  // A place that is not a number is somewhere too.
  const auto index = [](double n) {
    return n > -1e6 ? static_cast<int>(std::floor(std::min(n, 1e6))) : -1'000'000;
  };
  const Vec n = (position - origin_cell_corner_) / origin_cell_size_;
  return {index(n.x()), index(n.y())};
}

Order sort_into_clusters(ThreadTeam& team, const Grid& grid, std::span<const double> x,
                         std::span<const double> y, std::span<const double> id) {
  const RowLists rows = particles_of_rows(team, grid, y, id);
  std::vector<std::uint32_t> sorted(rows.particles.size());
  std::vector<std::uint32_t> slots(grid.rows() + 1, 0);  // of each row, then their first
  const auto sorted_of = [&](std::size_t row) {
    return std::span(sorted.data() + rows.begin[row], sorted.data() + rows.begin[row + 1]);
  };
  for_rows(team, grid, [&](std::size_t row) {
    sort_row(grid, x, y, id, rows.of(row), sorted_of(row));
    slots[row + 1] = walk_clusters(grid, x, sorted_of(row), [](std::uint32_t, std::uint32_t) {});
  });
  std::partial_sum(slots.begin(), slots.end(), slots.begin());

  Order order;
  Layout& layout = order.layout;
  for (const std::uint32_t slot : slots) {
    layout.row_begin.push_back(slot / static_cast<std::uint32_t>(kCluster));
  }
  constexpr std::size_t kWhole = kCluster * kWholeVectors;
  layout.slot_count = (slots.back() + kWhole - 1) / kWhole * kWhole;
  layout.chunk = chunk_of(layout.clusters());
  order.source.assign(layout.slot_count, Order::kEmpty);
  for_rows(team, grid, [&](std::size_t row) {
    std::uint32_t* const source = order.source.data() + slots[row];
    walk_clusters(grid, x, sorted_of(row),
                  [&](std::uint32_t slot, std::uint32_t particle) { source[slot] = particle; });
  });
  return order;
}

}  // namespace sluice
