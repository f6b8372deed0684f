#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sluice {

/// Steps along each axis, -1, 0 or 1, from the origin cell of a cluster to that of a neighbour.
template <int Dim>
using OriginStep = std::array<int, Dim>;

/// An entry of a pair list: the number of a cluster j and, in the highest bits, the code of the
/// step from the origin cell of the cluster i to that of j. Codes count the steps row by row, from
/// -1 along every axis on.
template <int Dim>
struct ListEntry {
  static constexpr std::uint32_t kCodes = [] {
    std::uint32_t codes = 1;
    for (int axis = 0; axis < Dim; ++axis) codes *= 3;
    return codes;
  }();
  static constexpr std::uint32_t kSameOriginCell = kCodes / 2;
  static constexpr int kCodeBit = 32 - std::bit_width(kCodes - 1);

  [[nodiscard]] static constexpr std::uint32_t of(std::uint32_t cluster, std::uint32_t code) {
    return cluster | code << kCodeBit;
  }
  [[nodiscard]] static constexpr std::uint32_t cluster(std::uint32_t entry) {
    return entry & ((1U << kCodeBit) - 1U);
  }
  [[nodiscard]] static constexpr std::uint32_t code(std::uint32_t entry) {
    return entry >> kCodeBit;
  }

  [[nodiscard]] static constexpr std::uint32_t code_of(const OriginStep<Dim>& step) {
    std::uint32_t code = 0;
    for (int axis = Dim; axis-- > 0;) {
      code = 3 * code + static_cast<std::uint32_t>(step[static_cast<std::size_t>(axis)] + 1);
    }
    return code;
  }
  [[nodiscard]] static constexpr OriginStep<Dim> step_of(std::uint32_t code) {
    OriginStep<Dim> step{};
    for (int& along : step) {
      along = static_cast<int>(code % 3) - 1;
      code /= 3;
    }
    return step;
  }
};

/// What each code of ListEntry adds to the positions of the particles i, for each axis, so that
/// they are seen from the origin cell of cluster j. In the unit of the cell size.
template <typename T, int Dim>
struct OriginShift {
  std::array<std::array<T, ListEntry<Dim>::kCodes>, Dim> of{};

  OriginShift() = default;
  explicit OriginShift(T origin_cell_size) {
    for (std::uint32_t code = 0; code < ListEntry<Dim>::kCodes; ++code) {
      const OriginStep<Dim> step = ListEntry<Dim>::step_of(code);
      for (std::size_t axis = 0; axis < Dim; ++axis) {
        of[axis][code] = -static_cast<T>(step[axis]) * origin_cell_size;
      }
    }
  }
};

/// For every cluster of a set, the clusters of another that may hold a neighbour, chunk by chunk.
/// A list of a set with itself is mutual: it holds each pair of clusters once, and what is summed
/// over it goes to both. Every chunk then has sums of its own, for its clusters and for its halos,
/// so that no two chunks ever add to the same place and the result does not depend on threads.
struct PairList {
  struct Chunk {
    std::vector<std::uint32_t> entries;  ///< ListEntry
    std::vector<std::uint32_t> begin;    ///< of each cluster of the chunk, and the end
    std::vector<std::uint32_t> targets;  ///< mutual: place of each entry in the chunk's sums
    std::vector<std::uint32_t> halos;    ///< mutual: clusters of later chunks that have a place,
                                         ///< behind the chunk's own

    /// Places in the sums: own clusters, halos, and one that nobody reads.
    [[nodiscard]] std::size_t places() const { return begin.size() + halos.size(); }
  };

  std::vector<Chunk> chunks;

  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = 0;
    for (const Chunk& c : chunks) {
      for (const auto* a : {&c.entries, &c.begin, &c.targets, &c.halos}) sum += 4 * a->capacity();
    }
    return sum;
  }
};

}  // namespace sluice
