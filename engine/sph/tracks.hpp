#pragma once

#include <algorithm>

#include "engine/sph/pair_arrays.hpp"

namespace sluice {

/// Where the particles were, and how fast, when the pair lists were made, one entry per slot and
/// dimensionless as in PairArrays. Lists hold while particles keep to these straight lines: what
/// moves together needs no new list however fast it is.
template <typename T>
struct Tracks {
  AlignedArray<T> x, y;  ///< X
  AlignedArray<T> u, v;  ///< U

  [[nodiscard]] std::size_t bytes() const { return x.bytes() + y.bytes() + u.bytes() + v.bytes(); }
};

template <typename T>
struct TracksView {
  const T* x = nullptr;
  const T* y = nullptr;
  const T* u = nullptr;
  const T* v = nullptr;
};

/// What the lists allow: for `lifetime` a particle may be off its track by `least` and `per_speed`
/// times its speed, which is taken as |u| + |v|. Units h and c.
template <typename T>
struct Leeway {
  T lifetime{};
  T least{};
  T per_speed{};
};

/// Speed of a track along one axis for a particle of this speed, in c. A faster particle, or one
/// whose speed is not a number, leaves its track.
template <typename T>
[[nodiscard]] inline T track_speed(T speed) {
  return std::min(std::max(T{-1}, speed), T{1});
}

/// Farther from its tile's origin than this, in h, are only empty slots.
inline constexpr double kNowhere = 1e7;

}  // namespace sluice
