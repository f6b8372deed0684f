#pragma once

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <new>
#include <utility>

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

/// The values of a vector field, one array an axis.
template <typename T, int Dim>
using AlignedAxes = std::array<AlignedArray<T>, Dim>;

template <typename T, int Dim>
[[nodiscard]] std::array<const T*, Dim> data_of(const AlignedAxes<T, Dim>& axes) {
  std::array<const T*, Dim> data;
  for (std::size_t axis = 0; axis < Dim; ++axis) data[axis] = axes[axis].data();
  return data;
}

/// Read access to PairArrays.
template <typename T, int Dim>
struct PairView {
  std::array<const T*, Dim> position{};
  std::array<const T*, Dim> velocity{};
  const T* excess = nullptr;
  const T* volume = nullptr;
  const T* diffused = nullptr;
  const T* pressure_term = nullptr;
};

/// What the pair sums read of a set of particles, dimensionless (see terms-inl.hpp), one entry per
/// slot. Positions are relative to the origin of the cluster's origin cell, so that single
/// precision resolves them in a domain of any size.
template <typename T, int Dim>
struct PairArrays {
  AlignedAxes<T, Dim> position;   ///< X
  AlignedAxes<T, Dim> velocity;   ///< U
  AlignedArray<T> excess;         ///< s
  AlignedArray<T> volume;         ///< V
  AlignedArray<T> pressure_term;  ///< A
  AlignedArray<T> diffused;       ///< psi of the density diffusion; empty where that is s

  void resize(std::size_t slots) {
    for (auto* vector : {&position, &velocity}) {
      for (AlignedArray<T>& along : *vector) along.resize(slots);
    }
    for (auto* a : {&excess, &volume, &pressure_term}) a->resize(slots);
  }
  [[nodiscard]] PairView<T, Dim> view() const {
    const T* psi = diffused.size() > 0 ? diffused.data() : excess.data();
    return {.position = data_of<T, Dim>(position),
            .velocity = data_of<T, Dim>(velocity),
            .excess = excess.data(),
            .volume = volume.data(),
            .diffused = psi,
            .pressure_term = pressure_term.data()};
  }
  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto* vector : {&position, &velocity}) {
      for (const AlignedArray<T>& along : *vector) sum += along.bytes();
    }
    for (const auto* a : {&excess, &volume, &diffused, &pressure_term}) sum += a->bytes();
    return sum;
  }
};

/// Boxes that hold the clusters of a set, in h (ClusterBounds), with tails.
template <int Dim>
struct BoxesView {
  std::array<const float*, Dim> min{};
  std::array<const float*, Dim> max{};
  const float* x_max_before = nullptr;
  const float* x_min_after = nullptr;
};

}  // namespace sluice
