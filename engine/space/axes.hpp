#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/space/space_traits.hpp"
#include "engine/space/vec.hpp"

namespace sluice {

/// One value for each axis, of as many axes as a scene has.
template <class T>
struct AxisValues : std::vector<T> {
  AxisValues() : AxisValues(kPlaneDim) {}
  explicit AxisValues(std::size_t axes) : std::vector<T>(axes) {}
};

template <class T, int Dim>
struct PerAxisOf {
  using Type = std::array<T, Dim>;
};
template <class T>
struct PerAxisOf<T, kAnyDim> {
  using Type = AxisValues<T>;
};
/// One value for each axis of space, in the order of their names.
template <class T, int Dim>
using PerAxisN = typename PerAxisOf<T, Dim>::Type;
template <class T>
using PerAxis = PerAxisN<T, kAnyDim>;

/// The values of each axis in another container, moved there.
template <int Dim, class Axes>
[[nodiscard]] auto moved_axes(Axes from) {
  using Value = typename Axes::value_type;
  PerAxisN<Value, Dim> to;
  if constexpr (Dim == kAnyDim) to = PerAxisN<Value, Dim>(from.size());
  for (std::size_t axis = 0; axis < to.size(); ++axis) to[axis] = std::move(from[axis]);
  return to;
}

/// The i-th values of all axes, as a vector of a type of as many components.
template <int Dim, class Axes>
[[nodiscard]] auto gathered(const Axes& values, std::size_t i) {
  using Scalar = typename Axes::value_type::value_type;
  constexpr int kMost = Dim == kAnyDim ? kMostDim : Dim;
  Eigen::Matrix<Scalar, Dim, 1, 0, kMost, 1> vector(static_cast<Eigen::Index>(values.size()));
  for (std::size_t axis = 0; axis < values.size(); ++axis) {
    vector[static_cast<Eigen::Index>(axis)] = values[axis][i];
  }
  return vector;
}
template <class T, std::size_t kAxes>
[[nodiscard]] auto vector_of(const std::array<std::vector<T>, kAxes>& values, std::size_t i) {
  return gathered<static_cast<int>(kAxes)>(values, i);
}
template <class T>
[[nodiscard]] auto vector_of(const AxisValues<std::vector<T>>& values, std::size_t i) {
  return gathered<kAnyDim>(values, i);
}

/// Adds the components of a vector, each to the values of its axis.
template <class Axes, class Vector>
void append(Axes& values, const Vector& vector) {
  for (std::size_t axis = 0; axis < values.size(); ++axis) {
    values[axis].push_back(vector[static_cast<Eigen::Index>(axis)]);
  }
}

[[nodiscard]] inline std::string_view axis_name(Eigen::Index axis) {
  return SpaceTraits<kMostDim>::axis_names[static_cast<std::size_t>(axis)];
}

/// All axes but kUpAxis: a place on the floor.
[[nodiscard]] inline std::span<const int> floor_axes(int dimensions) {
  return std::span(SpaceTraits<kMostDim>::floor_axes)
      .first(static_cast<std::size_t>(dimensions) - 1);
}

[[nodiscard]] inline std::string energy_unit(int dimensions) {
  return std::string(
      in_dimensions(dimensions, []<int Dim>() { return SpaceTraits<Dim>::energy_unit; }));
}

[[nodiscard]] inline bool points_straight_down(const Vec& vector) {
  return vector[kUpAxis] < 0.0 && vector.cwiseAbs().sum() == -vector[kUpAxis];
}

}  // namespace sluice
