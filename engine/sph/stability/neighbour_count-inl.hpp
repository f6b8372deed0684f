#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "engine/sph/stability/neighbour_count.hpp"

namespace sluice {

/// Over all particles, neighbour by neighbour.
template <typename T, int Dim>
std::uint32_t count_most(const Layout& layout, const PairList& list,
                         const PairArrays<T, Dim>& pairs, T cut_off) {
  std::vector<std::uint32_t> count(layout.slots(), 0);
  const T cut_off_sq = cut_off * cut_off;
  for (std::size_t k = 0; k < list.chunks.size(); ++k) {
    const PairList::Chunk& chunk = list.chunks[k];
    for (std::size_t c = 0; c + 1 < chunk.begin.size(); ++c) {
      const std::size_t first_i = kCluster * (layout.chunk_begin(k) + c);
      for (std::uint32_t e = chunk.begin[c]; e < chunk.begin[c + 1]; ++e) {
        const std::size_t first_j = kCluster * ListEntry<Dim>::cluster(chunk.entries[e]);
        for (std::size_t i = first_i; i < first_i + kCluster; ++i) {
          for (std::size_t j = first_j; j < first_j + kCluster; ++j) {
            T r_sq{};
            for (std::size_t axis = 0; axis < Dim; ++axis) {
              const T away = pairs.value(axis, i) - pairs.value(axis, j);
              r_sq += away * away;
            }
            if (!(r_sq < cut_off_sq)) continue;
            ++count[i];
            if (first_i != first_j) ++count[j];
          }
        }
      }
    }
  }
  return count.empty() ? 0 : *std::max_element(count.begin(), count.end());
}

template <typename T, int Dim>
std::uint32_t most_neighbours(ThreadTeam& team, const Layout& layout, const PairList& list,
                              const ChunkSums<T>& sums, const PairArrays<T, Dim>& pairs,
                              double cut_off) {
  const std::vector<PairList::Chunk>& chunks = list.chunks;
  // Entries that a cluster takes part in, per place of each chunk.
  std::vector<std::vector<std::uint32_t>> met(chunks.size());
  team.run(chunks.size(), [&](std::size_t k) {
    met[k].assign(chunks[k].places(), 0);
    for (const std::uint32_t target : chunks[k].targets) ++met[k][target];
    for (std::size_t c = 0; c + 1 < chunks[k].begin.size(); ++c) {
      met[k][c] += chunks[k].begin[c + 1] - chunks[k].begin[c];
    }
  });
  std::vector<std::uint32_t> most_of(chunks.size(), 0);
  team.run(chunks.size(), [&](std::size_t k) {
    const auto own = static_cast<std::ptrdiff_t>(chunks[k].begin.size() - 1);
    std::vector<std::uint32_t> all(met[k].begin(), met[k].begin() + own);
    for (const Contribution& a : sums.contributions(k)) all[a.cluster] += met[a.chunk][a.place];
    for (const std::uint32_t entries : all) most_of[k] = std::max(most_of[k], entries);
  });
  std::uint32_t most = 0;
  for (const std::uint32_t entries : most_of) most = std::max(most, entries);
  if (most * kCluster <= kManyNeighbours<Dim>) return 0;
  most = count_most(layout, list, pairs, static_cast<T>(cut_off));
  return most > kManyNeighbours<Dim> ? most : 0;
}

}  // namespace sluice
