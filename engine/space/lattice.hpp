#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "engine/space/vec.hpp"

namespace sluice {

/// A cell of a lattice, counted along each axis.
template <int Dim>
using CellN = std::array<std::int64_t, Dim>;

/// The cell that is `by` cells further along every axis.
template <int Dim>
[[nodiscard]] CellN<Dim> shifted(CellN<Dim> cell, std::int64_t by) {
  for (std::int64_t& number : cell) number += by;
  return cell;
}

/// The cell's numbers as a vector.
template <int Dim>
[[nodiscard]] VecN<Dim> as_vector(const CellN<Dim>& cell) {
  VecN<Dim> result;
  for (int axis = 0; axis < Dim; ++axis) result[axis] = static_cast<double>(cell[axis]);
  return result;
}

/// The cell that a point lies in, of a lattice of unit cells that starts at the origin.
template <int Dim>
[[nodiscard]] CellN<Dim> cell_at(const VecN<Dim>& point) {
  CellN<Dim> cell;
  for (int axis = 0; axis < Dim; ++axis) {
    cell[axis] = static_cast<std::int64_t>(std::floor(point[axis]));
  }
  return cell;
}

/// The place of a cell among all between two, both included, row by row; that of `last` is their
/// number less one.
template <int Dim>
[[nodiscard]] std::size_t index_between(const CellN<Dim>& first, const CellN<Dim>& last,
                                        const CellN<Dim>& cell) {
  std::int64_t index = 0;
  for (int axis = Dim; axis-- > 0;) {
    index = index * (last[axis] - first[axis] + 1) + cell[axis] - first[axis];
  }
  return static_cast<std::size_t>(index);
}

/// Calls f(cell) for the first cell of each row between two cells, both included. Rows run along x
/// and are numbered (z, y): y fastest, from the lowest. Nothing where one axis has no cell.
template <int Dim, class F>
void for_each_row(const CellN<Dim>& first, const CellN<Dim>& last, const F& f) {
  for (int axis = 0; axis < Dim; ++axis) {
    if (first[axis] > last[axis]) return;
  }
  CellN<Dim> row = first;
  for (;;) {
    f(row);
    int axis = 1;
    for (; axis < Dim && row[axis] == last[axis]; ++axis) row[axis] = first[axis];
    if (axis == Dim) return;
    ++row[axis];
  }
}

/// Calls f(cell) for all cells between two, both included, row by row.
template <int Dim, class F>
void for_each_cell(const CellN<Dim>& first, const CellN<Dim>& last, const F& f) {
  for_each_row<Dim>(first, last, [&](CellN<Dim> cell) {
    for (; cell[0] <= last[0]; ++cell[0]) f(cell);
  });
}

}  // namespace sluice
