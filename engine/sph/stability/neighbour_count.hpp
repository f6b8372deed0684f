#pragma once

#include <cstdint>

#include "engine/sph/pairs/chunk_sums.hpp"
#include "engine/sph/pairs/layout.hpp"
#include "engine/sph/pairs/pair_arrays.hpp"
#include "engine/sph/threads/thread_team.hpp"

namespace sluice {

/// Points of a square or cubic lattice of which none is farther from one of them, itself included,
/// than the root of `most_sq` spacings.
template <int Dim>
[[nodiscard]] constexpr std::uint32_t lattice_points(int most_sq) {
  if constexpr (Dim == 0) {
    return 1;
  } else {
    std::uint32_t points = lattice_points<Dim - 1>(most_sq);
    for (int n = 1; n * n <= most_sq; ++n) points += 2 * lattice_points<Dim - 1>(most_sq - n * n);
    return points;
  }
}

/// Neighbours of a particle of a lattice within the paper's support, three spacings.
template <int Dim>
inline constexpr std::uint32_t kLatticeNeighbours = lattice_points<Dim>(3 * 3) - 1;

/// More neighbours than particles of a fluid ever have: where these many are, pairs clump. 200 in
/// the plane, of 28 on a lattice, and as many times those of a lattice in space.
template <int Dim>
inline constexpr std::uint32_t kManyNeighbours =
    200 * kLatticeNeighbours<Dim> / kLatticeNeighbours<2>;
[[nodiscard]] inline std::uint32_t many_neighbours(int dimensions) {
  return in_dimensions(dimensions, []<int Dim>() { return kManyNeighbours<Dim>; });
}

/// The largest number of neighbours within `cut_off`, in h, of one particle when it is more than
/// kManyNeighbours, else 0: a bound from the mutual list tells most cases. A neighbour in another
/// origin cell is left out.
template <typename T, int Dim>
[[nodiscard]] std::uint32_t most_neighbours(ThreadTeam& team, const Layout& layout,
                                            const PairList& list, const ChunkSums<T>& sums,
                                            const PairArrays<T, Dim>& pairs, double cut_off);

}  // namespace sluice
