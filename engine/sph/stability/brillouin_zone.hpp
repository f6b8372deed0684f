#pragma once

#include <algorithm>
#include <functional>

#include "engine/space/lattice.hpp"

namespace sluice {

/// Calls f(cell) for all cells between two, both included, column by column: the last axis is the
/// fastest. Sums over neighbours are in this order, which is part of their last bits.
template <int Dim, class F>
void for_each_cell_x_slowest(CellN<Dim> first, CellN<Dim> last, const F& f) {
  std::ranges::reverse(first);
  std::ranges::reverse(last);
  for_each_cell<Dim>(first, last, [&](CellN<Dim> cell) {
    std::ranges::reverse(cell);
    f(cell);
  });
}

/// Calls f(cell) for the waves of a cubic lattice that the symmetry of its cell leaves over: wave
/// vectors pi/(count dx) cell with count >= kx >= ky >= ... >= 0. The other waves are their mirror
/// images and those with the axes exchanged.
template <int Dim, class F>
void for_each_wave(std::int64_t count, const F& f) {
  for_each_cell_x_slowest<Dim>({}, shifted<Dim>({}, count), [&](const CellN<Dim>& cell) {
    if (std::ranges::is_sorted(cell, std::ranges::greater())) f(cell);
  });
}

}  // namespace sluice
