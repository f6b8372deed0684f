#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>

#include "engine/space/space_traits.hpp"
#include "engine/space/vec.hpp"

namespace sluice {

/// A wall that is lifted out of the tank from t = 0 on: the dummy particles in `place` stand still,
/// and go row by row as the lower edge passes them. Nothing of it is state: it follows from t.
template <int Dim>
struct GateMotionN {
  BoxN<Dim> place;     ///< m
  double speed = 0.0;  ///< upwards, m/s

  /// Whether a dummy particle there is gone at time t.
  [[nodiscard]] bool has_passed(const VecN<Dim>& p, double t) const {
    return place.contains(p) && p[kUpAxis] < place.min[kUpAxis] + speed * t;
  }
};

/// Where the fluid of a run may be: what lies outside is removed. Empty parts bound nothing but the
/// box.
template <int Dim>
struct FlowDomainN {
  BoxN<Dim> box;                   ///< a particle that leaves it is removed
  std::optional<double> wall_top;  ///< m; leaving above it is overtopping, below it a leak; absent:
                                   ///< no open tank
  /// m; outside of it a particle is over the wall from over_from() on and removed at once, so that
  /// what falls down behind a wall is not taken for a leak. It has no end upwards or downwards.
  BoxN<Dim> rim = BoxN<Dim>::everywhere();

  /// m; what is outside of the room and below this height is deep in a wall of the tank. Of an open
  /// tank that is a little below wall_top: what comes over a rim may lie down on it.
  BoxN<Dim> room = BoxN<Dim>::everywhere();
  double walls_reach = std::numeric_limits<double>::infinity();
  std::optional<GateMotionN<Dim>> gate;
  /// Whether a place is in an obstacle or in the gate at time t; empty: there is none. Asked once
  /// in a while for each particle, on any thread.
  std::function<bool(const VecN<Dim>&, double t)> in_solid;

  /// Height from which on a particle beyond a rim's middle is over it, m: little below wall_top,
  /// for what runs over a rim sinks into its outer edge.
  [[nodiscard]] double over_from() const {
    return wall_top ? std::min(*wall_top, walls_reach) : std::numeric_limits<double>::infinity();
  }
  /// Whether a particle there stays in the run.
  [[nodiscard]] bool keeps(const VecN<Dim>& p) const {
    const bool over = p[kUpAxis] >= over_from() && !rim.contains(p);
    const bool in_wall = p[kUpAxis] < walls_reach && !room.contains(p);
    return box.contains(p) && !over && !in_wall;
  }
};

using GateMotion = GateMotionN<kAnyDim>;
using FlowDomain = FlowDomainN<kAnyDim>;

/// The same domain for another type of vectors, of as many dimensions.
template <int To, int From>
[[nodiscard]] FlowDomainN<To> domain_as(const FlowDomainN<From>& domain) {
  FlowDomainN<To> result;
  result.box = domain.box;
  result.wall_top = domain.wall_top;
  result.rim = domain.rim;
  result.room = domain.room;
  result.walls_reach = domain.walls_reach;
  if (domain.gate) result.gate = GateMotionN<To>{domain.gate->place, domain.gate->speed};
  if (domain.in_solid) {
    result.in_solid = [ask = domain.in_solid](const VecN<To>& place, double time) {
      return ask(place, time);
    };
  }
  return result;
}

}  // namespace sluice
