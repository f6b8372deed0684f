#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/sph/layout.hpp"
#include "engine/sph/pair_arrays.hpp"
#include "engine/sph/sweeps.hpp"
#include "engine/sph/thread_team.hpp"

namespace sluice {

/// Extents of the clusters of one set at the last sort, in smoothing lengths, for the search for
/// neighbours.
struct ClusterBounds {
  std::vector<float> x_min, x_max, y_min, y_max;
  std::vector<float> reach;  ///< largest of the cluster's particles
  std::vector<Grid::Tile> tile;
  std::vector<float> strip_y_min, strip_y_max, strip_reach;

  /// Positions and reaches per slot in m; empty slots have id < 0.
  void assign(const Grid& grid, const Layout& layout, double smoothing_length, const double* x,
              const double* y, const double* reach_of, const double* id);
};

/// For every cluster of `self` the clusters of `other` that hold a particle within the cut-off plus
/// both reaches, in memory order. Chunks are independent tasks of the team.
template <typename T>
void build_pair_list(ThreadTeam& team, const Sweeps<T>& sweeps, T cut_off, T tile_size,
                     const Layout& self_layout, const ClusterBounds& self_bounds,
                     const PairView<T>& self, const Layout& other_layout,
                     const ClusterBounds& other_bounds, const PairView<T>& other, PairList& list);

extern template void build_pair_list<float>(ThreadTeam&, const Sweeps<float>&, float, float,
                                            const Layout&, const ClusterBounds&,
                                            const PairView<float>&, const Layout&,
                                            const ClusterBounds&, const PairView<float>&,
                                            PairList&);
extern template void build_pair_list<double>(ThreadTeam&, const Sweeps<double>&, double, double,
                                             const Layout&, const ClusterBounds&,
                                             const PairView<double>&, const Layout&,
                                             const ClusterBounds&, const PairView<double>&,
                                             PairList&);

}  // namespace sluice
