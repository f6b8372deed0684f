#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/scene/model/shapes.hpp"
#include "engine/space/lattice.hpp"

namespace sluice {

/// Whole number of cells of about `spacing` along `length`, at least one.
[[nodiscard]] inline std::int64_t whole_cells(double length, double spacing) {
  return std::max<std::int64_t>(1, std::llround(length / spacing));
}

/// How a cuboid's cells fit its sides.
enum class CellFit {
  exact_spacing,  ///< cells of dx along each axis; the last ones may stand out by up to dx/2
  stretched,      ///< sides of the cells changed a little so that a whole number fits
};

/// The cells of a lattice whose centres lie in a shape, kept as runs along its rows. The lattice
/// starts at the lowest corner of a cuboid and at the origin for every other shape.
template <int Dim>
class CellSetN {
 public:
  CellSetN(const ShapeN<Dim>& shape, double spacing, CellFit fit);

  [[nodiscard]] std::size_t size() const;
  /// Whether a point lies in the cells; on the boundary of one (to a millionth of its width), only
  /// if the cells on all sides are in the set.
  [[nodiscard]] bool covers(const VecN<Dim>& point) const;
  /// Whether every cell up to `layers` cells away along each axis is in the set too.
  [[nodiscard]] bool is_deep(const CellN<Dim>& cell, std::int64_t layers) const;

  /// Calls f(centre, cell) for each cell, row by row: see for_each_row().
  template <class F>
  void for_each(const F& f) const {
    for (const Run& run : runs_) {
      for (CellN<Dim> cell = run.first; cell[0] <= run.last; ++cell[0]) f(center(cell), cell);
    }
  }

 private:
  /// Cells of a row, from `first` to the one at `last`.
  struct Run {
    CellN<Dim> first;
    std::int64_t last;
  };

  [[nodiscard]] VecN<Dim> center(const CellN<Dim>& cell) const;
  /// Whether all cells of a row from `first` to the one at `last` are in the set.
  [[nodiscard]] bool holds(const CellN<Dim>& first, std::int64_t last) const;
  void add(const Cuboid<Dim>& cuboid, double spacing, CellFit fit);
  template <class Round>
  void add(const Round& shape, double spacing, CellFit fit);
  void add_run(CellN<Dim> row, double from, double to);

  VecN<Dim> origin_ = VecN<Dim>::Zero();
  VecN<Dim> step_ = VecN<Dim>::Zero();
  std::vector<Run> runs_;  ///< by row, then along it; apart from one another
};

}  // namespace sluice
