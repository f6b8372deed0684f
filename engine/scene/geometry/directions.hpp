#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "engine/space/vec.hpp"

namespace sluice {

/// Unit vectors spread evenly over all directions, `count` of them. In the plane they go round from
/// the x axis, the first one `offset` of a step away from it.
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

}  // namespace sluice
