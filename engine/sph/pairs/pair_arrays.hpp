#pragma once

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <utility>
#include <vector>

namespace sluice {

/// Particles per cluster: pair sums run cluster against cluster.
inline constexpr std::size_t kCluster = 4;

/// Room for a little more than `size`: the number of slots changes with every order.
[[nodiscard]] inline std::size_t with_slack(std::size_t size) { return size + size / 128; }

/// Values of a whole vector on the widest target: as many past the end may be read, not used.
inline constexpr std::size_t kTail = 16;

/// A growing aligned array with a tail. Throws std::bad_alloc.
template <typename T>
class AlignedArray {
 public:
  void resize(std::size_t size) {
    if (size > capacity_) {
      const std::size_t capacity = with_slack(size);
      auto data = hwy::AllocateAligned<T>(capacity + kTail);
      if (!data) throw std::bad_alloc();
      std::fill(data.get(), data.get() + capacity + kTail, T{});
      data_ = std::move(data);
      capacity_ = capacity;
    }
    size_ = size;
  }
  [[nodiscard]] T* data() { return data_.get(); }
  [[nodiscard]] const T* data() const { return data_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t bytes() const { return (capacity_ + kTail) * sizeof(T); }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  hwy::AlignedFreeUniquePtr<T[]> data_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// Resizes a vector with little to spare; left to itself it grows to twice its size.
template <typename Vector>
void resize_closely(Vector& values, std::size_t size) {
  if (values.capacity() < size) values.reserve(with_slack(size));
  values.resize(size);
}

/// Read access to PairArrays.
template <typename T>
struct PairView {
  const T* x = nullptr;
  const T* y = nullptr;
  const T* u = nullptr;
  const T* v = nullptr;
  const T* excess = nullptr;
  const T* volume = nullptr;
  const T* diffused = nullptr;
  const T* pressure_term = nullptr;
};

/// What the pair sums read of a set of particles, dimensionless (see terms-inl.hpp), one entry per
/// slot. Positions are relative to the origin of the cluster's origin cell, so that single
/// precision resolves them in a domain of any size.
template <typename T>
struct PairArrays {
  AlignedArray<T> x, y;           ///< X
  AlignedArray<T> u, v;           ///< U
  AlignedArray<T> excess;         ///< s
  AlignedArray<T> volume;         ///< V
  AlignedArray<T> pressure_term;  ///< A
  AlignedArray<T> diffused;       ///< psi of the density diffusion; empty where that is s

  void resize(std::size_t slots) {
    for (auto* a : {&x, &y, &u, &v, &excess, &volume, &pressure_term}) a->resize(slots);
  }
  [[nodiscard]] PairView<T> view() const {
    const T* psi = diffused.size() > 0 ? diffused.data() : excess.data();
    return {.x = x.data(),
            .y = y.data(),
            .u = u.data(),
            .v = v.data(),
            .excess = excess.data(),
            .volume = volume.data(),
            .diffused = psi,
            .pressure_term = pressure_term.data()};
  }
  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto* a : {&x, &y, &u, &v, &excess, &volume, &diffused, &pressure_term}) {
      sum += a->bytes();
    }
    return sum;
  }
};

/// Boxes that hold the clusters of a set, in h (ClusterBounds), with tails.
struct BoxesView {
  const float* x_min = nullptr;
  const float* x_max = nullptr;
  const float* y_min = nullptr;
  const float* y_max = nullptr;
  const float* x_max_before = nullptr;
  const float* x_min_after = nullptr;
};

/// For every cluster of a set, the clusters of another that may hold a neighbour, chunk by chunk.
/// A list of a set with itself is mutual: it holds each pair of clusters once, and what is summed
/// over it goes to both. Every chunk then has sums of its own, for its clusters and for its halos,
/// so that no two chunks ever add to the same place and the result does not depend on threads.
struct PairList {
  struct Chunk {
    std::vector<std::uint32_t> entries;  ///< cluster index | origin cell shift code << kShiftBit
    std::vector<std::uint32_t> begin;    ///< of each cluster of the chunk, and the end
    std::vector<std::uint32_t> targets;  ///< mutual: place of each entry in the chunk's sums
    std::vector<std::uint32_t> halos;    ///< mutual: clusters of later chunks that have a place,
                                         ///< behind the chunk's own

    /// Places in the sums: own clusters, halos, and one that nobody reads.
    [[nodiscard]] std::size_t places() const { return begin.size() + halos.size(); }
  };
  static constexpr std::uint32_t kShiftBit = 28;
  static constexpr std::uint32_t kClusterMask = (1U << kShiftBit) - 1U;

  std::vector<Chunk> chunks;

  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = 0;
    for (const Chunk& c : chunks) {
      for (const auto* a : {&c.entries, &c.begin, &c.targets, &c.halos}) sum += 4 * a->capacity();
    }
    return sum;
  }
};

/// How the sums of a mutual list lie in memory: `stride` values per place, in blocks of one value
/// per particle of the cluster. A block that a sweep does not sum is 0.
struct SumBlocks {
  std::size_t stride = 0;
  std::size_t density = 0;
  std::size_t y = 0;
  std::size_t x = 0;
  std::size_t trace = 0;
};
inline constexpr SumBlocks kDensitySums{kCluster, 0, 0, 0};
inline constexpr SumBlocks kAccelerationSums{2 * kCluster, 0, 0, kCluster};
/// With particle shifting: eq. 4, and sums that tell where particles lack (ShiftingTerm).
inline constexpr SumBlocks kDensityAndShiftingSums{4 * kCluster, 0, kCluster, 2 * kCluster,
                                                   3 * kCluster};
inline constexpr SumBlocks kRateSums{4 * kCluster, 0, kCluster, 2 * kCluster};
/// eq. 10: `density` is the numerator, `x` the divisor.
inline constexpr SumBlocks kReinitialisationSums{2 * kCluster, 0, 0, kCluster};

/// Sums that a chunk holds for a cluster of another: its `place` there, and the cluster's number in
/// its own chunk.
struct Contribution {
  std::uint32_t chunk, place, cluster;
};

/// Origin cell shift codes 0-8: (X_j's origin cell - X_i's origin cell) + 1 in each direction, row
/// by row; 4 is the same origin cell.
inline constexpr std::uint32_t kSameOriginCell = 4;

}  // namespace sluice
