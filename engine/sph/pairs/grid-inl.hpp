#pragma once

#include <algorithm>
#include <cmath>

#include "engine/sph/pairs/grid.hpp"

namespace sluice {
namespace grid {

inline constexpr double kMaxCells = 1 << 20;         // of a row
inline constexpr double kMaxRows = 1 << 20;          // of all of them
inline constexpr double kSingleOriginCell = 1024.0;  // smoothing lengths
inline constexpr double kOriginCell = 512.0;         // smoothing lengths

/// The number of a cell or row `distance` behind the first, of `count` that are `size` wide.
inline std::size_t index_of(double distance, double size, std::size_t count) {
  const double n = distance / size;
  if (!(n >= 1.0)) return 0;
  return std::min(static_cast<std::size_t>(std::min(n, kMaxCells * 4.0)), count - 1);
}

}  // namespace grid

template <int Dim>
Grid<Dim>::Grid(const BoxN<Dim>& domain, double spacing, double smoothing_length,
                std::size_t particles)
    : origin_(domain.min) {
  using grid::kMaxCells;
  const VecN<Dim> length = domain.size();
  const double most_rows = std::pow(grid::kMaxRows, 1.0 / (Dim - 1));  // along one axis
  const auto set_axis = [&](int axis, double most) {
    size_[axis] = std::max(2.0 * spacing, length[axis] / most);
    // A row edge at 0 puts two whole rows of a lattice that starts there into each row.
    if (axis != 0) origin_[axis] = std::floor(domain.min[axis] / size_[axis]) * size_[axis];
    const double counted = (domain.max[axis] - origin_[axis]) / size_[axis];
    return count_[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(counted) + 1;
  };
  for (int axis = 1; axis < Dim; ++axis) rows_ *= set_axis(axis, most_rows);
  const double most_cells =
      std::max(1.0, static_cast<double>(8 * particles + 65536) / static_cast<double>(rows_));
  set_axis(0, std::min(most_cells, kMaxCells));
  max_cluster_length_ = std::max(6.0 * spacing, 3.0 * smoothing_length);

  one_origin_cell_ = length.maxCoeff() <= grid::kSingleOriginCell * smoothing_length;
  origin_cell_size_ =
      (one_origin_cell_ ? 4.0 * grid::kSingleOriginCell : grid::kOriginCell) * smoothing_length;
  origin_cell_corner_ = one_origin_cell_ ? VecN<Dim>((domain.min + domain.max) / 2.0 -
                                                     VecN<Dim>::Constant(origin_cell_size_ / 2.0))
                                         : domain.min;
}

template <int Dim>
std::size_t Grid<Dim>::row(const VecN<Dim>& position) const {
  std::size_t row = 0;
  for (int axis = Dim; --axis > 0;) {
    const std::size_t count = count_[static_cast<std::size_t>(axis)];
    row = row * count + grid::index_of(position[axis] - origin_[axis], size_[axis], count);
  }
  return row;
}

template <int Dim>
std::size_t Grid<Dim>::cell(double x) const {
  return grid::index_of(x - origin_[0], size_[0], count_[0]);
}

template <int Dim>
typename Grid<Dim>::OriginCell Grid<Dim>::origin_cell(const VecN<Dim>& position) const {
  OriginCell cell{};
  if (one_origin_cell_) return cell;
  const VecN<Dim> n = (position - origin_cell_corner_) / origin_cell_size_;
  for (int axis = 0; axis < Dim; ++axis) {
    // A place that is not a number is somewhere too.
    cell[static_cast<std::size_t>(axis)] =
        n[axis] > -1e6 ? static_cast<int>(std::floor(std::min(n[axis], 1e6))) : -1'000'000;
  }
  return cell;
}

template <int Dim>
VecN<Dim> Grid<Dim>::origin_cell_center(const OriginCell& cell) const {
  VecN<Dim> center = origin_cell_corner_;
  for (int axis = 0; axis < Dim; ++axis) {
    center[axis] += origin_cell_size_ * (cell[static_cast<std::size_t>(axis)] + 0.5);
  }
  return center;
}

}  // namespace sluice
