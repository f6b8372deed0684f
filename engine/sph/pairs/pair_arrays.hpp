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

/// The fields of PairArrays, in the order in which those of a cluster lie in memory.
template <int Dim>
struct PairFields {
  static constexpr std::size_t position = 0;                 ///< X, one field an axis
  static constexpr std::size_t velocity = Dim;               ///< U, likewise
  static constexpr std::size_t excess = 2 * Dim;             ///< s
  static constexpr std::size_t volume = 2 * Dim + 1;         ///< V
  static constexpr std::size_t diffused = 2 * Dim + 2;       ///< psi of the density diffusion
  static constexpr std::size_t pressure_term = 2 * Dim + 3;  ///< A
  static constexpr std::size_t count = 2 * Dim + 4;

  /// Place of a field's value for a slot, and of its first after that of the first slot of all.
  [[nodiscard]] static constexpr std::size_t at(std::size_t slot) {
    return slot / kCluster * (count * kCluster) + slot % kCluster;
  }
  [[nodiscard]] static constexpr std::size_t begin(std::size_t field) { return field * kCluster; }
};

/// Read access to PairArrays.
template <typename T, int Dim>
struct PairView {
  const T* values = nullptr;
  std::size_t diffused = PairFields<Dim>::diffused;  ///< the field that is psi
};

/// What the pair sums read of a set of particles, dimensionless (see terms-inl.hpp), one value per
/// slot. The fields of a cluster lie side by side: a sweep that comes to a cluster finds them all
/// in a few lines of the cache. Positions are relative to the origin of the cluster's origin cell,
/// so that single precision resolves them in a domain of any size.
template <typename T, int Dim>
class PairArrays {
 public:
  using Fields = PairFields<Dim>;

  /// The values of a field.
  class Field {
   public:
    Field(T* values, std::size_t field) : begin_(values + Fields::begin(field)) {}
    T& operator[](std::size_t slot) const { return begin_[Fields::at(slot)]; }

   private:
    T* begin_;
  };

  void resize(std::size_t slots) { values_.resize(Fields::at(slots)); }
  /// psi is a field of its own. Otherwise it is s.
  void keep_diffused() { diffused_ = Fields::diffused; }
  [[nodiscard]] bool keeps_diffused() const { return diffused_ == Fields::diffused; }

  [[nodiscard]] Field field(std::size_t which) { return {values_.data(), which}; }
  [[nodiscard]] Field position(std::size_t axis) { return field(Fields::position + axis); }
  [[nodiscard]] Field excess() { return field(Fields::excess); }
  [[nodiscard]] Field volume() { return field(Fields::volume); }
  [[nodiscard]] Field pressure_term() { return field(Fields::pressure_term); }
  [[nodiscard]] T value(std::size_t which, std::size_t slot) const {
    return values_[Fields::begin(which) + Fields::at(slot)];
  }
  /// The values of a field for the cluster that begins with a slot.
  [[nodiscard]] T* cluster(std::size_t which, std::size_t slot) {
    return values_.data() + Fields::begin(which) + Fields::at(slot);
  }
  [[nodiscard]] const T* cluster(std::size_t which, std::size_t slot) const {
    return values_.data() + Fields::begin(which) + Fields::at(slot);
  }

  [[nodiscard]] PairView<T, Dim> view() const { return {values_.data(), diffused_}; }
  [[nodiscard]] std::size_t bytes() const { return values_.bytes(); }

 private:
  AlignedArray<T> values_;
  std::size_t diffused_ = Fields::excess;
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
