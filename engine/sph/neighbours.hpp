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
  void assign(ThreadTeam& team, const Grid& grid, const Layout& layout, double smoothing_length,
              const double* x, const double* y, const double* reach_of, const double* id);
};

/// A set of particles as the search sees it.
template <typename T>
struct PairSet {
  const Layout& layout;
  const ClusterBounds& bounds;
  PairView<T> pairs;
};

/// Lengths of the search, in h.
template <typename T>
struct PairRange {
  T cut_off;
  T tile_size;
};

/// For every cluster of `self` the clusters of `other` that hold a particle within the cut-off plus
/// both reaches, in memory order. When `self` and `other` are the same object the list is mutual:
/// it holds those from the cluster itself on. Chunks are independent tasks of the team.
template <typename T>
void build_pair_list(ThreadTeam& team, const Sweeps<T>& sweeps, const PairRange<T>& range,
                     const PairSet<T>& self, const PairSet<T>& other, PairList& list);

extern template void build_pair_list<float>(ThreadTeam&, const Sweeps<float>&,
                                            const PairRange<float>&, const PairSet<float>&,
                                            const PairSet<float>&, PairList&);
extern template void build_pair_list<double>(ThreadTeam&, const Sweeps<double>&,
                                             const PairRange<double>&, const PairSet<double>&,
                                             const PairSet<double>&, PairList&);

}  // namespace sluice
