#pragma once

#include <array>
#include <cstddef>

#include "engine/space/vec.hpp"

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

}  // namespace sluice
