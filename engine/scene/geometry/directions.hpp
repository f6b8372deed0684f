#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "engine/space/vec.hpp"

namespace sluice {

/// Unit vectors spread evenly over all directions, `count` of them. In the plane they go round from
/// the x axis, the first one `offset` of a step away from it; in space they climb a spiral of equal
/// areas round the y axis (a Fibonacci lattice), turned by `offset` of a step.
template <int Dim>
[[nodiscard]] std::vector<VecN<Dim>> directions(int count, double offset = 0.0);

/// The same over half of all directions: of each line through a point one.
template <int Dim>
[[nodiscard]] std::vector<VecN<Dim>> half_of_directions(int count);

template <>
inline std::vector<VecN<2>> directions<2>(int count, double offset) {
  std::vector<VecN<2>> result;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * (k + offset) / count;
    result.emplace_back(std::cos(angle), std::sin(angle));
  }
  return result;
}

template <>
inline std::vector<VecN<2>> half_of_directions<2>(int count) {
  std::vector<VecN<2>> result = directions<2>(2 * count);
  result.resize(static_cast<std::size_t>(count));
  return result;
}

namespace directions_in_space {

/// The k-th point of a spiral of equal areas at the height y, `offset` of a step turned.
[[nodiscard]] inline VecN<3> on_spiral(double y, double k) {
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double radius = std::sqrt(1.0 - y * y);
  return {radius * std::cos(golden_angle * k), y, radius * std::sin(golden_angle * k)};
}

}  // namespace directions_in_space

template <>
inline std::vector<VecN<3>> directions<3>(int count, double offset) {
  std::vector<VecN<3>> result;
  result.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    result.push_back(directions_in_space::on_spiral(1.0 - (2.0 * k + 1.0) / count, k + offset));
  }
  return result;
}

template <>
inline std::vector<VecN<3>> half_of_directions<3>(int count) {
  std::vector<VecN<3>> result;
  result.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    result.push_back(directions_in_space::on_spiral(1.0 - (k + 0.5) / count, k));
  }
  return result;
}

}  // namespace sluice
