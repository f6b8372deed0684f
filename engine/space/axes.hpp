#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "engine/space/space_traits.hpp"
#include "engine/space/vec.hpp"

namespace sluice {

/// One value for each axis of space, in the order of their names.
template <class T>
using PerAxis = std::array<T, kDim>;

/// The i-th values of all axes.
template <class T, std::size_t kAxes>
[[nodiscard]] auto vector_of(const std::array<std::vector<T>, kAxes>& values, std::size_t i) {
  Eigen::Matrix<T, static_cast<int>(kAxes), 1> vector;
  for (std::size_t axis = 0; axis < values.size(); ++axis) {
    vector[static_cast<Eigen::Index>(axis)] = values[axis][i];
  }
  return vector;
}

/// Adds the components of a vector, each to the values of its axis.
template <class T, std::size_t kAxes, class Vector>
void append(std::array<std::vector<T>, kAxes>& values, const Vector& vector) {
  for (std::size_t axis = 0; axis < values.size(); ++axis) {
    values[axis].push_back(vector[static_cast<Eigen::Index>(axis)]);
  }
}

[[nodiscard]] inline std::string_view axis_name(Eigen::Index axis) {
  return SpaceTraits<kDim>::axis_names[static_cast<std::size_t>(axis)];
}

/// All axes but kUpAxis: a place on the floor.
inline constexpr auto kFloorAxes = SpaceTraits<kDim>::floor_axes;

[[nodiscard]] inline bool points_straight_down(const Vec& vector) {
  return vector[kUpAxis] < 0.0 && vector.cwiseAbs().sum() == -vector[kUpAxis];
}

}  // namespace sluice
