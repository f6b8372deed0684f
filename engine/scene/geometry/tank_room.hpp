#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "engine/scene/model/scene.hpp"
#include "engine/space/space_traits.hpp"

namespace sluice {

/// The inside of a tank, [0, size], between solid walls on all sides; with an open top there is air
/// above `size`, also beside it.
template <int Dim>
struct TankRoomN {
  VecN<Dim> size = VecN<Dim>::Zero();  ///< m
  bool open_top = true;

  /// How far a point is beyond the side walls, m; negative between them.
  [[nodiscard]] double aside(const VecN<Dim>& p) const {
    double most = std::max(-p[0], p[0] - size[0]);
    for (int axis = kUpAxis + 1; axis < Dim; ++axis) {
      most = std::max({most, -p[axis], p[axis] - size[axis]});
    }
    return most;
  }
  /// How far it is above the rim or the lid, m.
  [[nodiscard]] double over(const VecN<Dim>& p) const { return p[kUpAxis] - size[kUpAxis]; }
  /// Whether a point is between the side walls and touches none, at any height.
  [[nodiscard]] bool between_sides(const VecN<Dim>& p) const { return aside(p) < 0.0; }

  /// How far a point in the walls is from the open, m; 0 in the open.
  [[nodiscard]] double depth_in_walls(const VecN<Dim>& p) const {
    // Over the rim of an open tank is the air; a wall is left upwards too.
    if (open_top) {
      if (over(p) >= 0) return 0.0;
      return std::max({0.0, -p[kUpAxis], std::min(aside(p), -over(p))});
    }
    return std::max({0.0, -p[kUpAxis], aside(p), over(p)});
  }

  /// Whether a point is in the open and at least so far from all walls, m.
  [[nodiscard]] bool leaves_room(const VecN<Dim>& p, double margin) const {
    if (p[kUpAxis] < margin || (!open_top && -over(p) < margin)) return false;
    // Beside a wall, or above its rim.
    return !(std::hypot(std::max(0.0, -aside(p)), std::max(0.0, over(p))) < margin);
  }
};

/// Of a tank in as many dimensions.
template <int Dim>
[[nodiscard]] TankRoomN<Dim> room_of(const Tank& tank) {
  return {tank.size(), tank.open_top};
}
template <int Dim>
[[nodiscard]] std::optional<TankRoomN<Dim>> room_of(const Scene& scene) {
  return scene.tank ? std::optional(room_of<Dim>(*scene.tank)) : std::nullopt;
}

}  // namespace sluice
