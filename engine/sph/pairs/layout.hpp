#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/space/vec.hpp"
#include "engine/sph/pairs/pair_arrays.hpp"
#include "engine/sph/threads/thread_team.hpp"

namespace sluice {

/// The fixed geometry of the order of particles in memory: rows along x, two spacings high in all
/// other directions, and along a row cells two spacings wide (wider in a vast and almost empty
/// domain). Rows are numbered (z, y): y fastest, from the lowest. It depends on the scene alone,
/// never on where particles went.
template <int Dim>
class Grid {
 public:
  /// `particles` bounds the memory that the grid may use. Lengths in m.
  Grid(const BoxN<Dim>& domain, double spacing, double smoothing_length, std::size_t particles);

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t cells() const { return count_[0]; }
  /// Positions outside the domain count to the nearest row and cell.
  [[nodiscard]] std::size_t row(const VecN<Dim>& position) const;
  [[nodiscard]] std::size_t cell(double x) const;
  /// A cluster spans at most this much of a row, m.
  [[nodiscard]] double max_cluster_length() const { return max_cluster_length_; }

  /// Origin cells: cubes whose centres are the origins of single-precision positions, counted along
  /// each axis. One origin cell where that resolves 3e-5 h.
  using OriginCell = std::array<int, Dim>;
  [[nodiscard]] OriginCell origin_cell(const VecN<Dim>& position) const;
  [[nodiscard]] VecN<Dim> origin_cell_center(const OriginCell& cell) const;
  [[nodiscard]] double origin_cell_size() const { return origin_cell_size_; }
  /// Whether there is no other origin cell than one.
  [[nodiscard]] bool has_one_origin_cell() const { return one_origin_cell_; }

 private:
  VecN<Dim> origin_;                      // of cells and rows, m
  VecN<Dim> size_;                        // of a cell, and of a row along all other axes, m
  std::array<std::size_t, Dim> count_{};  // of cells in a row, and of rows along all other axes
  std::size_t rows_ = 1;
  double max_cluster_length_;
  bool one_origin_cell_;
  double origin_cell_size_;
  VecN<Dim> origin_cell_corner_;
};

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
