#pragma once

#include <algorithm>

#include "engine/scene/geometry/too_thin.hpp"

namespace sluice {

template <int Dim>
bool is_long_way(WaysN<Dim>& ways, const VecN<Dim>& place, double thickness) {
  const auto length = ways.length_to(place);
  const double allowed = kWayPerThickness * std::clamp(thickness, 0.0, kThinnestSolid);
  return length && *length > kShortWay + allowed;
}

template <int Dim>
bool keeps_apart(const SolidsN<Dim>& solids, const VecN<Dim>& one, const VecN<Dim>& other,
                 double thickness, double spacing) {
  WaysN<Dim> ways(solids, spacing);
  ways.seek(one, kAroundLongestWay, kLongestWay);
  return !ways.shut() && is_long_way(ways, other, thickness / spacing);
}

}  // namespace sluice
