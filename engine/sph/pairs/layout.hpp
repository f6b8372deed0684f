#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/space/vec.hpp"
#include "engine/sph/pairs/grid.hpp"
#include "engine/sph/pairs/pair_arrays.hpp"
#include "engine/sph/threads/thread_team.hpp"

namespace sluice {

/// Where particles go in memory: row by row, by x inside a row, four to a cluster. A row
/// starts a new cluster and so does a gap; slots left over are empty.
struct Layout {
  std::vector<std::uint32_t> row_begin;  ///< first cluster of each row, and the end
  std::size_t slot_count = 0;
  std::size_t chunk = 1;  ///< clusters per chunk, the unit of work of a thread

  [[nodiscard]] std::size_t slots() const { return slot_count; }
  [[nodiscard]] std::size_t clusters() const { return slot_count / kCluster; }
  [[nodiscard]] std::size_t chunks() const { return (clusters() + chunk - 1) / chunk; }
  [[nodiscard]] std::size_t chunk_begin(std::size_t n) const {
    return std::min(n * chunk, clusters());
  }
};

/// A layout, and who goes where in it.
struct Order {
  static constexpr std::uint32_t kEmpty = std::numeric_limits<std::uint32_t>::max();

  Layout layout;
  std::vector<std::uint32_t> source;  ///< per slot: index of the particle, or kEmpty
};

/// The values of each axis, one for each slot.
template <int Dim>
using AxisSpans = std::array<std::span<const double>, Dim>;

template <int Dim>
[[nodiscard]] AxisSpans<Dim> spans_of(const std::array<std::vector<double>, Dim>& axes) {
  AxisSpans<Dim> spans;
  for (std::size_t axis = 0; axis < Dim; ++axis) spans[axis] = axes[axis];
  return spans;
}

template <int Dim>
[[nodiscard]] VecN<Dim> place_in(const AxisSpans<Dim>& position, std::size_t slot) {
  VecN<Dim> place;
  for (int axis = 0; axis < Dim; ++axis) {
    place[axis] = position[static_cast<std::size_t>(axis)][slot];
  }
  return place;
}

/// Orders the particles by (row, x, y, z, id). The order of the input changes nothing. Slots with
/// id < 0 are empty and are left out.
template <int Dim>
[[nodiscard]] Order sort_into_clusters(ThreadTeam& team, const Grid<Dim>& grid,
                                       const AxisSpans<Dim>& position, std::span<const double> id);

}  // namespace sluice
