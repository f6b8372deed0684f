#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "engine/sph/pairs/pair_arrays.hpp"

namespace sluice {

/// What the lists allow: for `lifetime` a particle may be off its path by `least` and `per_speed`
/// times its speed, which is taken as the sum of |U| along all axes. Units h and c.
template <typename T>
struct Skin {
  T lifetime{};
  T least{};
  T per_speed{};
};

/// Read access to ListPaths.
template <typename T, int Dim>
struct ListPathsView {
  std::array<const T*, Dim> position{};
  std::array<const T*, Dim> velocity{};
  Skin<T> skin{};
};

/// How long pair lists serve changes no bit of a result, for what is beyond the support adds zero.
/// Longer lists serve longer and hold more pairs that are none: a particle may be off its path by
/// this much and a twentieth of its way along it. Twice that would spare a twelfth of the lists
/// and sum 3 % more pairs (tests/bench/README.md).
template <typename T>
[[nodiscard]] inline Skin<T> skin_for(double lifetime) {
  return {static_cast<T>(lifetime), static_cast<T>(0.05), static_cast<T>(0.05 * lifetime)};
}

/// For how long new lists are made, h/c. Where particles collide some leave their paths within a
/// few h/c, and lists that were to serve for longer would hold pairs in vain.
class ListLifetime {
 public:
  [[nodiscard]] double value() const { return value_; }
  /// Lists expired at this age, before their time.
  void expired(double age) { value_ = std::clamp(kSpare * age, kShortest, kLongest); }
  /// Lists served for all of their time.
  void served() { value_ = std::min(kSpare * value_, kLongest); }

 private:
  static constexpr double kShortest = 2.0;
  static constexpr double kLongest = 15.0;
  static constexpr double kSpare = 1.5;
  double value_ = kLongest;
};

/// Speed of a path along one axis for a particle of this speed, in c. A faster particle, or one
/// whose speed is not a number, leaves its path.
template <typename T>
[[nodiscard]] inline T path_speed(T speed) {
  return std::min(std::max(T{-1}, speed), T{1});
}

/// Where the particles were, and how fast, when the pair lists were made, one entry per slot and
/// dimensionless as in PairArrays. Lists hold while particles keep to these straight lines: what
/// moves together needs no new list however fast it is.
template <typename T, int Dim>
struct ListPaths {
  AlignedAxes<T, Dim> position;     ///< X
  AlignedAxes<T, Dim> velocity;     ///< U
  Skin<T> skin = skin_for<T>(0.0);  ///< within which the lists hold
  double age = 0.0;                 ///< of the lists, h/c

  void resize(std::size_t slots) {
    for (auto* vector : {&position, &velocity}) {
      for (AlignedArray<T>& along : *vector) along.resize(slots);
    }
  }
  /// Begins the paths of the slots [begin, end) where they are.
  void begin(const PairArrays<T, Dim>& now, std::size_t begin, std::size_t end) {
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      for (std::size_t s = begin; s < end; ++s) {
        using Fields = PairFields<Dim>;
        position[axis][s] = now.value(Fields::position + axis, s);
        velocity[axis][s] = path_speed(now.value(Fields::velocity + axis, s));
      }
    }
  }
  [[nodiscard]] ListPathsView<T, Dim> view() const {
    return {data_of<T, Dim>(position), data_of<T, Dim>(velocity), skin};
  }
  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto* vector : {&position, &velocity}) {
      for (const AlignedArray<T>& along : *vector) sum += along.bytes();
    }
    return sum;
  }
};

/// Farther from its origin cell's origin than this, in h, are only empty slots.
inline constexpr double kNowhere = 1e7;

/// A coordinate in h that no kernel reaches, for a slot that holds nothing; no two slots are near
/// each other.
[[nodiscard]] inline double nowhere(std::size_t slot) {
  return 10.0 * kNowhere * static_cast<double>(slot + 1);
}

}  // namespace sluice
