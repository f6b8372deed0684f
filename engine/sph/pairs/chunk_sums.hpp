#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/sph/pairs/pair_arrays.hpp"
#include "engine/sph/pairs/pair_list.hpp"
#include "engine/sph/pairs/sum_blocks.hpp"

namespace sluice {

/// The sums over a mutual list, chunk by chunk, and who brings what to whom. Every chunk has sums
/// of its own, for its clusters and for its halos, so that no two chunks ever add to the same
/// place; what is for a halo waits there until the halo's chunk takes it, in the order of chunks.
template <typename T>
class ChunkSums {
 public:
  /// Room for `stride` values per place of every chunk of `clusters_per_chunk` clusters.
  void place(const PairList& list, std::size_t clusters_per_chunk, std::size_t stride) {
    const std::size_t chunks = list.chunks.size();
    sums_.resize(chunks);
    of_chunks_.resize(chunks);
    contributions_.resize(chunks);
    for (auto& contributions : contributions_) contributions.clear();
    sources_.resize(chunks);
    for (auto& sources : sources_) sources.clear();
    for (std::size_t k = 0; k < chunks; ++k) {
      const PairList::Chunk& chunk = list.chunks[k];
      sums_[k].resize(stride * chunk.places());
      of_chunks_[k] = sums_[k].data();
      std::size_t place = chunk.begin.size() - 1;
      for (const std::uint32_t halo : chunk.halos) {
        const std::size_t target = halo / clusters_per_chunk;
        contributions_[target].push_back({static_cast<std::uint32_t>(k),
                                          static_cast<std::uint32_t>(place++),
                                          static_cast<std::uint32_t>(halo % clusters_per_chunk)});
        add_source(target, k);
      }
    }
    // A vector that a sweep loads at the end of its chunk may reach into the next, unused.
    for (std::size_t k = 1; k < chunks; ++k) add_source(k, k - 1);
  }

  [[nodiscard]] T* of(std::size_t chunk) const { return of_chunks_[chunk]; }
  [[nodiscard]] T* const* of_chunks() const { return of_chunks_.data(); }
  /// What others have for the clusters of `chunk`, in the order of chunks.
  [[nodiscard]] std::span<const Contribution> contributions(std::size_t chunk) const {
    return contributions_[chunk];
  }
  /// The chunks, all of them earlier, whose sweeps read particles of `chunk` or have sums for them.
  [[nodiscard]] std::span<const std::uint32_t> sources(std::size_t chunk) const {
    return sources_[chunk];
  }
  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& sums : sums_) sum += sums.bytes();
    for (const auto& contributions : contributions_)
      sum += contributions.capacity() * sizeof(Contribution);
    for (const auto& sources : sources_) sum += sources.capacity() * sizeof(std::uint32_t);
    return sum;
  }

 private:
  void add_source(std::size_t chunk, std::size_t source) {
    std::vector<std::uint32_t>& sources = sources_[chunk];
    const auto one = static_cast<std::uint32_t>(source);
    if (sources.empty() || sources.back() != one) sources.push_back(one);
  }

  std::vector<AlignedArray<T>> sums_;
  std::vector<T*> of_chunks_;
  std::vector<std::vector<Contribution>> contributions_;
  std::vector<std::vector<std::uint32_t>> sources_;
};

}  // namespace sluice
