#pragma once

#include <span>

#include "engine/sph/loops/sweeps.hpp"
#include "engine/sph/pairs/layout.hpp"
#include "engine/sph/pairs/list_paths.hpp"
#include "engine/sph/pairs/pair_list.hpp"
#include "engine/sph/solver/cluster_bounds.hpp"
#include "engine/sph/threads/thread_team.hpp"

namespace sluice {

/// A set of particles as the search sees it.
template <typename T, int Dim>
struct PairSet {
  const Layout& layout;
  const ClusterBounds<Dim>& bounds;
  ListPathsView<T, Dim> paths;
};

/// How far the search goes.
template <typename T, int Dim>
struct PairRange {
  T cut_off;                         ///< h
  const OriginShift<T, Dim>& shift;  ///< h
  bool one_origin_cell;              ///< Grid::has_one_origin_cell()
};

/// A list to build: for every cluster of `self` the clusters of `other` of which a particle may
/// come within the cut-off, in memory order. When `self` and `other` are the same object the list
/// is mutual: it holds those from the cluster itself on.
template <typename T, int Dim>
struct NewPairList {
  const PairSet<T, Dim>* self;
  const PairSet<T, Dim>* other;
  PairList* list;
};

/// Builds lists. The chunks of all are independent tasks of the team: few of the fluid's are near a
/// wall, so that the threads could not share the list of the two by itself.
template <typename T, int Dim>
void build_pair_lists(ThreadTeam& team, const Sweeps<T, Dim>& sweeps,
                      const PairRange<T, Dim>& range, std::span<const NewPairList<T, Dim>> lists);

}  // namespace sluice
