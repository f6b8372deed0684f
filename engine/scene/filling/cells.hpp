#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// Whole number of cells of about `spacing` along `length`, at least one.
[[nodiscard]] std::int64_t whole_cells(double length, double spacing);

/// How a rectangle's cells fit its sides.
enum class CellFit {
  exact_spacing,  ///< cells of dx x dx; the last ones may stand out by up to dx/2
  stretched,      ///< sides of the cells changed a little so that a whole number fits
};

/// The cells of a lattice whose centres lie in a shape, kept as runs along its rows. The lattice
/// starts at the lower left corner of a rectangle and at the origin for every other shape.
class CellSet {
 public:
  CellSet(const Shape& shape, double spacing, CellFit fit);

  [[nodiscard]] std::size_t size() const;
  /// Whether a point lies in the cells; on the boundary of one (to a millionth of its width), only
  /// if the cells on all sides are in the set.
  [[nodiscard]] bool covers(const Vec& point) const;
  /// Whether every cell up to `layers` rows and columns away is in the set too.
  [[nodiscard]] bool is_deep(std::int64_t row, std::int64_t column, std::int64_t layers) const;

  /// Calls f(centre, row, column) for each cell, rows from the bottom up, each from the left.
  template <class F>
  void for_each(const F& f) const {
    for (const Run& run : runs_) {
      for (std::int64_t column = run.first; column <= run.last; ++column) {
        f(center(run.row, column), run.row, column);
      }
    }
  }

 private:
  /// Cells [first, last] of a row.
  struct Run {
    std::int64_t row;
    std::int64_t first;
    std::int64_t last;
  };

  [[nodiscard]] Vec center(std::int64_t row, std::int64_t column) const;
  [[nodiscard]] bool holds(std::int64_t row, std::int64_t first, std::int64_t last) const;
  void add_rectangle(const Rectangle& rectangle, double spacing, CellFit fit);
  void add_rows(const Shape& shape);
  void add_run(std::int64_t row, double from, double to);

  Vec origin_ = Vec::Zero();
  Vec step_ = Vec::Zero();
  std::vector<Run> runs_;  ///< by row, then by column; apart from one another
};

}  // namespace sluice
