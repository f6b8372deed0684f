#pragma once

#include <cstdint>

#include "engine/sph/pairs/chunk_sums.hpp"
#include "engine/sph/pairs/layout.hpp"
#include "engine/sph/pairs/pair_arrays.hpp"
#include "engine/sph/threads/thread_team.hpp"

namespace sluice {

/// More neighbours than particles of a fluid in the plane ever have: where these many are, pairs
/// clump.
inline constexpr std::uint32_t kManyNeighbours = 200;

/// The largest number of neighbours within `cut_off`, in h, of one particle when it is more than
/// kManyNeighbours, else 0: a bound from the mutual list tells most cases. A neighbour in another
/// origin cell is left out.
template <typename T, int Dim>
[[nodiscard]] std::uint32_t most_neighbours(ThreadTeam& team, const Layout& layout,
                                            const PairList& list, const ChunkSums<T>& sums,
                                            const PairArrays<T, Dim>& pairs, double cut_off);

}  // namespace sluice
