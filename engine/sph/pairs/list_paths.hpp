#pragma once

#include <algorithm>
#include <cstddef>

#include "engine/sph/pairs/pair_arrays.hpp"

namespace sluice {

template <typename T>
struct ListPathsView {
  const T* x = nullptr;
  const T* y = nullptr;
  const T* u = nullptr;
  const T* v = nullptr;
};

/// What the lists allow: for `lifetime` a particle may be off its path by `least` and `per_speed`
/// times its speed, which is taken as |u| + |v|. Units h and c.
template <typename T>
struct Skin {
  T lifetime{};
  T least{};
  T per_speed{};
};

/// How long pair lists serve changes no bit of a result, for what is beyond the support adds zero.
/// Longer lists serve longer and hold more pairs that are none: a particle may be off its path by
/// this much and a twentieth of its way along it. Twice that would spare a twelfth of the lists
/// and sum 3 % more pairs (tests/bench/README.md).
template <typename T>
inline constexpr Skin<T> kSkin{T{15}, static_cast<T>(0.05), static_cast<T>(0.05 * 15.0)};

/// Speed of a path along one axis for a particle of this speed, in c. A faster particle, or one
/// whose speed is not a number, leaves its path.
template <typename T>
[[nodiscard]] inline T path_speed(T speed) {
  return std::min(std::max(T{-1}, speed), T{1});
}

/// Where the particles were, and how fast, when the pair lists were made, one entry per slot and
/// dimensionless as in PairArrays. Lists hold while particles keep to these straight lines: what
/// moves together needs no new list however fast it is.
template <typename T>
struct ListPaths {
  AlignedArray<T> x, y;  ///< X
  AlignedArray<T> u, v;  ///< U
  double age = 0.0;      ///< of the lists, h/c

  void resize(std::size_t slots) {
    for (auto* a : {&x, &y, &u, &v}) a->resize(slots);
  }
  /// Begins the paths of the slots [begin, end) where they are.
  void begin(const PairArrays<T>& now, std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      x[s] = now.x[s];
      y[s] = now.y[s];
      u[s] = path_speed(now.u[s]);
      v[s] = path_speed(now.v[s]);
    }
  }
  [[nodiscard]] ListPathsView<T> view() const { return {x.data(), y.data(), u.data(), v.data()}; }
  [[nodiscard]] std::size_t bytes() const { return x.bytes() + y.bytes() + u.bytes() + v.bytes(); }
};

/// Farther from its origin cell's origin than this, in h, are only empty slots.
inline constexpr double kNowhere = 1e7;

/// A coordinate in h that no kernel reaches, for a slot that holds nothing; no two slots are near
/// each other.
[[nodiscard]] inline double nowhere(std::size_t slot) {
  return 10.0 * kNowhere * static_cast<double>(slot + 1);
}

}  // namespace sluice
