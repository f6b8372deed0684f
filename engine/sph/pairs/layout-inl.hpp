#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/sph/pairs/layout.hpp"

namespace sluice {
namespace clusters {

inline constexpr std::size_t kPart = 1024;  // least slots to a part that is counted by itself
inline constexpr std::size_t kMostParts = 64;
inline constexpr std::size_t kRows = 4;  // to a task
inline constexpr std::size_t kWholeVectors =
    4;  // clusters: every target's loops end on a whole vector

// A large chunk has few neighbours in other chunks, all the fewer the more rows it spans; its
// sums should stay in the second cache, and several threads need several chunks: where their number
// is odd one of two threads gets one more, a tenth of the time where they are 11.
inline constexpr std::size_t kLeastChunks = 16;
inline constexpr std::size_t kManyChunks = 64;  // where chunks may grow beyond kChunk
inline constexpr std::size_t kLeastChunk = 32;  // clusters
inline constexpr std::size_t kChunk = 512;
inline constexpr std::size_t kMostChunk = 2560;

/// Clusters per chunk of so many clusters.
inline std::size_t chunk_of(std::size_t clusters) {
  const std::size_t share = (clusters + kLeastChunks - 1) / kLeastChunks;
  const std::size_t few = std::clamp(share, kLeastChunk, kChunk);
  const std::size_t many = std::min(clusters / kManyChunks, kMostChunk);
  return (std::max(few, many) + kWholeVectors - 1) / kWholeVectors * kWholeVectors;
}

template <int Dim, class Body>
void for_rows(ThreadTeam& team, const Grid<Dim>& grid, const Body& body) {
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

template <int Dim>
RowLists particles_of_rows(ThreadTeam& team, const Grid<Dim>& grid, const AxisSpans<Dim>& position,
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
      row_of[p] = static_cast<std::uint32_t>(grid.row(place_in<Dim>(position, p)));
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

/// The particles of a row by (x, y, z, id): a counting sort by cell, then an insertion sort. Linear
/// while a cell holds a few, or what it holds comes nearly sorted.
template <int Dim>
void sort_row(const Grid<Dim>& grid, const AxisSpans<Dim>& position, std::span<const double> id,
              std::span<const std::uint32_t> particles, std::span<std::uint32_t> sorted) {
  if (particles.empty()) return;
  const std::span<const double> x = position[0];
  thread_local std::vector<std::uint32_t> next;  // of each cell
  next.assign(grid.cells() + 1, 0);
  for (const std::uint32_t p : particles) ++next[grid.cell(x[p]) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (const std::uint32_t p : particles) sorted[next[grid.cell(x[p])]++] = p;

  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    for (const std::span<const double>& along : position) {
      if (along[a] != along[b]) return along[a] < along[b];
    }
    return id[a] < id[b];
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
template <int Dim, class Put>
std::uint32_t walk_clusters(const Grid<Dim>& grid, std::span<const double> x,
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

}  // namespace clusters

template <int Dim>
Order sort_into_clusters(ThreadTeam& team, const Grid<Dim>& grid, const AxisSpans<Dim>& position,
                         std::span<const double> id) {
  const std::span<const double> x = position[0];
  const clusters::RowLists rows = clusters::particles_of_rows<Dim>(team, grid, position, id);
  std::vector<std::uint32_t> sorted(rows.particles.size());
  std::vector<std::uint32_t> slots(grid.rows() + 1, 0);  // of each row, then their first
  const auto sorted_of = [&](std::size_t row) {
    return std::span(sorted.data() + rows.begin[row], sorted.data() + rows.begin[row + 1]);
  };
  clusters::for_rows(team, grid, [&](std::size_t row) {
    clusters::sort_row<Dim>(grid, position, id, rows.of(row), sorted_of(row));
    slots[row + 1] =
        clusters::walk_clusters(grid, x, sorted_of(row), [](std::uint32_t, std::uint32_t) {});
  });
  std::partial_sum(slots.begin(), slots.end(), slots.begin());

  Order order;
  Layout& layout = order.layout;
  for (const std::uint32_t slot : slots) {
    layout.row_begin.push_back(slot / static_cast<std::uint32_t>(kCluster));
  }
  constexpr std::size_t kWhole = kCluster * clusters::kWholeVectors;
  layout.slot_count = (slots.back() + kWhole - 1) / kWhole * kWhole;
  layout.chunk = clusters::chunk_of(layout.clusters());
  order.source.assign(layout.slot_count, Order::kEmpty);
  clusters::for_rows(team, grid, [&](std::size_t row) {
    std::uint32_t* const source = order.source.data() + slots[row];
    clusters::walk_clusters(
        grid, x, sorted_of(row),
        [&](std::uint32_t slot, std::uint32_t particle) { source[slot] = particle; });
  });
  return order;
}

}  // namespace sluice
