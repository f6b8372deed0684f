#pragma once

#include <algorithm>

#include "engine/scene/geometry/too_thin.hpp"

namespace sluice {

inline double longest_short_way(double thickness) {
  return kShortWay + kWayPerThickness * std::clamp(thickness, 0.0, kThinnestSolid);
}

template <int Dim>
bool is_long_way(WaysN<Dim>& ways, const VecN<Dim>& place, double thickness) {
  const auto length = ways.length_to(place);
  return length && *length > longest_short_way(thickness);
}

template <int Dim>
bool keeps_apart(const SolidsN<Dim>& solids, const VecN<Dim>& one, const VecN<Dim>& other,
                 double thickness, double spacing) {
  WaysN<Dim> ways(solids, spacing);
  ways.seek(one, other, kAroundLongestWay, longest_short_way(thickness / spacing));
  return !ways.shut() && is_long_way(ways, other, thickness / spacing);
}

}  // namespace sluice
