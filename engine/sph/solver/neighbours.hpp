#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/sph/loops/sweeps.hpp"
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
struct ClusterBounds {
  AlignedArray<float> x_min, x_max, y_min, y_max;
  AlignedArray<float> x_max_before;           ///< largest x_max of the row up to the cluster
  AlignedArray<float> x_min_after;            ///< least x_min of the row from the cluster on
  std::vector<Grid::OriginCell> origin_cell;  ///< of the sorted places
  std::vector<float> row_y_min, row_y_max;
  std::vector<float> row_y_max_before;  ///< largest row_y_max up to the row
  std::vector<float> row_y_min_after;   ///< least row_y_min from the row on

  /// Sorted places per slot in m; empty slots have id < 0.
  void assign_origin_cells(ThreadTeam& team, const Grid& grid, const Layout& layout,
                           const double* x, const double* y, const double* id);

  /// Room for the boxes of all clusters.
  void resize(const Layout& layout);
  /// The boxes of the clusters [begin, end) by their paths; the smoothing length in m.
  template <typename T>
  void assign_boxes(std::size_t begin, std::size_t end, const Grid& grid, double smoothing_length,
                    const ListPathsView<T>& paths);
  /// What follows from all boxes.
  void assign_rows(ThreadTeam& team, const Layout& layout);

  /// No row before this one reaches up to y.
  [[nodiscard]] std::size_t first_row(float y) const;

  [[nodiscard]] BoxesView view() const {
    return {x_min.data(), x_max.data(),        y_min.data(),
            y_max.data(), x_max_before.data(), x_min_after.data()};
  }
  /// Of what there is per cluster.
  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = origin_cell.capacity() * sizeof(Grid::OriginCell);
    for (const auto* a : {&x_min, &x_max, &y_min, &y_max, &x_max_before, &x_min_after}) {
      sum += a->bytes();
    }
    return sum;
  }
};

/// A set of particles as the search sees it.
template <typename T>
struct PairSet {
  const Layout& layout;
  const ClusterBounds& bounds;
  ListPathsView<T> paths;
};

/// How far the search goes.
template <typename T>
struct PairRange {
  T cut_off;             ///< h
  T origin_cell_size;    ///< h
  bool one_origin_cell;  ///< Grid::has_one_origin_cell()
};

/// A list to build: for every cluster of `self` the clusters of `other` of which a particle may
/// come within the cut-off, in memory order. When `self` and `other` are the same object the list
/// is mutual: it holds those from the cluster itself on.
template <typename T>
struct NewPairList {
  const PairSet<T>* self;
  const PairSet<T>* other;
  PairList* list;
};

/// Builds lists. The chunks of all are independent tasks of the team: few of the fluid's are near a
/// wall, so that the threads could not share the list of the two by itself.
template <typename T>
void build_pair_lists(ThreadTeam& team, const Sweeps<T>& sweeps, const PairRange<T>& range,
                      std::span<const NewPairList<T>> lists);

extern template void build_pair_lists<float>(ThreadTeam&, const Sweeps<float>&,
                                             const PairRange<float>&,
                                             std::span<const NewPairList<float>>);
extern template void build_pair_lists<double>(ThreadTeam&, const Sweeps<double>&,
                                              const PairRange<double>&,
                                              std::span<const NewPairList<double>>);

}  // namespace sluice
