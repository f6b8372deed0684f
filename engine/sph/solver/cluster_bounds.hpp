#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "engine/sph/pairs/grid.hpp"
#include "engine/sph/pairs/layout.hpp"
#include "engine/sph/pairs/list_paths.hpp"
#include "engine/sph/pairs/pair_arrays.hpp"
#include "engine/sph/threads/thread_team.hpp"

namespace sluice {

/// In single precision and a little farther towards -1 or 1: the value's own rounding, and that of
/// a sum with it.
[[nodiscard]] inline float outwards(double value, double towards) {
  constexpr double kRounding = 2.0 * std::numeric_limits<float>::epsilon();
  return static_cast<float>(value + towards * kRounding * std::abs(value));
}

/// Boxes, in smoothing lengths, that the clusters of one set stay in while their particles are
/// within the skin of their paths.
template <int Dim>
struct ClusterBounds {
  static constexpr std::size_t kLastAxis = Dim - 1;

  AlignedAxes<float, Dim> min, max;
  AlignedArray<float> x_max_before;  ///< largest max[0] of the row up to the cluster
  AlignedArray<float> x_min_after;   ///< least min[0] of the row from the cluster on
  std::vector<typename Grid<Dim>::OriginCell> origin_cell;  ///< of the sorted places

  /// Boxes of the rows, of use along all axes but x.
  std::array<std::vector<float>, Dim> row_min, row_max;
  /// Rows are numbered along the last axis first.
  std::vector<float> row_max_before;  ///< largest row_max[kLastAxis] up to the row
  std::vector<float> row_min_after;   ///< least row_min[kLastAxis] from the row on

  /// Sorted places per slot in m; empty slots have id < 0.
  void assign_origin_cells(ThreadTeam& team, const Grid<Dim>& grid, const Layout& layout,
                           const AxisSpans<Dim>& position, std::span<const double> id);

  /// Room for the boxes of all clusters.
  void resize(const Layout& layout);
  /// The boxes of the clusters [begin, end) by their paths; the smoothing length in m.
  template <typename T>
  void assign_boxes(std::size_t begin, std::size_t end, const Grid<Dim>& grid,
                    double smoothing_length, const ListPathsView<T, Dim>& paths);
  /// What follows from all boxes.
  void assign_rows(ThreadTeam& team, const Layout& layout);

  /// Calls body(row) for the rows, from `first` on, whose boxes meet the box from `low` to `high`
  /// along all axes but x. Rows without a cluster are among them.
  template <class Body>
  void for_rows_in(const std::array<float, Dim>& low, const std::array<float, Dim>& high,
                   std::size_t first, const Body& body) const;

  [[nodiscard]] BoxesView<Dim> view() const {
    return {data_of<float, Dim>(min), data_of<float, Dim>(max), x_max_before.data(),
            x_min_after.data()};
  }
  /// Of what there is per cluster.
  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = origin_cell.capacity() * sizeof(typename Grid<Dim>::OriginCell);
    for (const auto* vector : {&min, &max}) {
      for (const AlignedArray<float>& along : *vector) sum += along.bytes();
    }
    return sum + x_max_before.bytes() + x_min_after.bytes();
  }
};

template <int Dim>
template <class Body>
void ClusterBounds<Dim>::for_rows_in(const std::array<float, Dim>& low,
                                     const std::array<float, Dim>& high, std::size_t first,
                                     const Body& body) const {
  const auto reached =
      std::lower_bound(row_max_before.begin(), row_max_before.end(), low[kLastAxis]);
  const auto nearest = static_cast<std::size_t>(reached - row_max_before.begin());
  for (std::size_t row = std::max(first, nearest); row < row_min_after.size(); ++row) {
    if (row_min_after[row] > high[kLastAxis]) break;
    bool near = true;
    for (std::size_t axis = 1; axis < Dim; ++axis) {
      near &= row_max[axis][row] >= low[axis] && row_min[axis][row] <= high[axis];
    }
    if (near) body(row);
  }
}

}  // namespace sluice
