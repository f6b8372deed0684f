#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "engine/sph/pairs/pair_arrays.hpp"

namespace sluice {

/// How the sums of a mutual list lie in memory: `stride` values per place, in blocks of one value
/// per particle of the cluster. A block that a sweep does not sum is 0, and not read.
template <int Dim>
struct SumBlocks {
  std::size_t stride = 0;
  std::size_t count = 0;  ///< blocks that are summed; the stride may have room for more
  std::size_t density = 0;
  std::array<std::size_t, Dim> vector{};  ///< of its components
  std::size_t trace = 0;
  std::size_t divisor = 0;  ///< of eq. 10, whose numerator is `density`
};

/// Blocks for the components of a vector from block `first` on: that of the last axis comes first.
template <int Dim>
[[nodiscard]] constexpr std::array<std::size_t, Dim> component_blocks(std::size_t first) {
  std::array<std::size_t, Dim> blocks{};
  for (std::size_t axis = 0; axis < Dim; ++axis) blocks[axis] = first + Dim - 1 - axis;
  return blocks;
}

template <int Dim>
inline constexpr SumBlocks<Dim> kDensitySums{.stride = kCluster, .count = 1};
template <int Dim>
inline constexpr SumBlocks<Dim> kAccelerationSums{
    .stride = Dim * kCluster, .count = Dim, .vector = component_blocks<Dim>(0)};
/// With particle shifting: eq. 4, and sums that tell where particles lack (ShiftingSummands).
template <int Dim>
inline constexpr SumBlocks<Dim> kDensityAndShiftingSums{.stride = (Dim + 2) * kCluster,
                                                        .count = Dim + 2,
                                                        .vector = component_blocks<Dim>(1),
                                                        .trace = Dim + 1};
/// Room for a power of two of blocks: all of a place are one vector of the widest target.
template <int Dim>
inline constexpr SumBlocks<Dim> kRateSums{.stride = std::bit_ceil(Dim + 1U) * kCluster,
                                          .count = Dim + 1,
                                          .vector = component_blocks<Dim>(1)};
template <int Dim>
inline constexpr SumBlocks<Dim> kReinitialisationSums{
    .stride = 2 * kCluster, .count = 2, .divisor = 1};

/// Sums that a chunk holds for a cluster of another: its `place` there, and the cluster's number in
/// its own chunk.
struct Contribution {
  std::uint32_t chunk, place, cluster;
};

}  // namespace sluice
