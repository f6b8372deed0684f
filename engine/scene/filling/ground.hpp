#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engine/scene/filling/intervals.hpp"
#include "engine/space/lattice.hpp"
#include "engine/space/space_traits.hpp"

namespace sluice {

// The ground is what all axes but up span: a line below the plane, a plane below space.

/// The point of the ground below a place.
template <int Dim>
[[nodiscard]] VecN<Dim> foot_of(VecN<Dim> place) {
  place[kUpAxis] = 0.0;
  return place;
}
/// The cell of the ground below a cell.
template <int Dim>
[[nodiscard]] CellN<Dim> on_ground(CellN<Dim> cell) {
  cell[kUpAxis] = 0;
  return cell;
}

/// A height times a measure on the ground: that of cells with some sides, `parts` to each.
template <int Dim>
[[nodiscard]] double over_ground(double height, const VecN<Dim>& sides, double parts) {
  for (int axis = 0; axis < Dim; ++axis) {
    if (axis != kUpAxis) height = height * sides[axis] / parts;
  }
  return height;
}

/// A line upwards from the middle of each cell of a lattice on the ground, as intervals.
template <int Dim>
class LinesOnGround {
 public:
  /// About `step` apart over a box.
  LinesOnGround(const BoxN<Dim>& box, double step) : low_(box.min) {
    CellN<Dim> count{};
    for (int axis = 0; axis < Dim; ++axis) {
      count[axis] = static_cast<std::int64_t>(std::llround(box.size()[axis] / step));
    }
    sides_ = box.size().cwiseQuotient(as_vector<Dim>(count));
    last_ = on_ground<Dim>(shifted<Dim>(count, -1));
    lines_.resize(index(last_) + 1);
  }

  [[nodiscard]] const VecN<Dim>& sides() const { return sides_; }
  [[nodiscard]] const CellN<Dim>& last() const { return last_; }
  [[nodiscard]] VecN<Dim> foot(const CellN<Dim>& cell) const {
    return foot_of<Dim>(low_ + (as_vector<Dim>(cell).array() + 0.5).matrix().cwiseProduct(sides_));
  }
  [[nodiscard]] bool has(const CellN<Dim>& cell) const {
    for (int axis = 0; axis < Dim; ++axis) {
      if (cell[axis] < 0 || cell[axis] > last_[axis]) return false;
    }
    return true;
  }
  [[nodiscard]] Intervals& operator[](const CellN<Dim>& cell) { return lines_[index(cell)]; }

  /// Calls f(line) for the lines up to `reach` cells away along each axis.
  template <class F>
  void for_each_near(const CellN<Dim>& cell, std::int64_t reach, const F& f) {
    CellN<Dim> first = on_ground<Dim>(shifted<Dim>(cell, -reach));
    CellN<Dim> last = on_ground<Dim>(shifted<Dim>(cell, reach));
    for (int axis = 0; axis < Dim; ++axis) {
      first[axis] = std::max<std::int64_t>(first[axis], 0);
      last[axis] = std::min(last[axis], last_[axis]);
    }
    for_each_cell<Dim>(first, last, [&](const CellN<Dim>& other) { f(lines_[index(other)]); });
  }

 private:
  [[nodiscard]] std::size_t index(const CellN<Dim>& cell) const {
    return index_between<Dim>({}, last_, cell);
  }

  VecN<Dim> low_;
  VecN<Dim> sides_;
  CellN<Dim> last_;
  std::vector<Intervals> lines_;
};

}  // namespace sluice
