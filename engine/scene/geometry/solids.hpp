#pragma once

#include <optional>
#include <vector>

#include "engine/scene/geometry/tank_room.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

/// All that is solid in a scene but a gate: the obstacles and, around the tank, the rest of the
/// world but the air above an open top.
template <int Dim>
class SolidsN {
 public:
  using Point = VecN<Dim>;

  /// `spacing` in m.
  SolidsN(const std::vector<ShapeN<Dim>>& obstacles, std::optional<TankRoomN<Dim>> tank,
          double spacing);

  [[nodiscard]] bool holds(const Point& point) const;
  /// Whether a point is in the open and at least this far from all that is solid, m.
  [[nodiscard]] bool leaves_room(const Point& point, double margin) const;
  /// How far a point is from the open, m: 0 in the open, also where one solid lies against another;
  /// there it is sought up to `most` in steps of `most`/32, and all that is deeper counts as that.
  [[nodiscard]] double depth(const Point& point, double most) const;
  /// The same of the walls around the tank alone.
  [[nodiscard]] double depth_in_walls(const Point& point) const;
  /// How far one gets from a point in the open or in a solid before that changes, m; nothing when
  /// it is `most` or more. `step` is the length that nothing shorter than is found.
  [[nodiscard]] std::optional<double> reach(const Point& from, const Point& direction, double most,
                                            double step) const;

 private:
  struct Body {
    ShapeN<Dim> shape;
    BoxN<Dim> box;
  };

  /// Whether the shortest way out of one body, where that is known, is no longer than `depth` and
  /// ends in the open.
  [[nodiscard]] bool gets_out(const Point& point, double depth) const;

  std::vector<Body> bodies_;
  std::optional<TankRoomN<Dim>> tank_;
  double slack_;             ///< m; gaps of rounding are none
  std::vector<Point> ways_;  ///< in which a depth is sought
};

/// The solids of a scene of as many dimensions.
template <int Dim>
[[nodiscard]] SolidsN<Dim> solids_of(const Scene& scene) {
  return {shapes_as<Dim>(scene.obstacles), room_of<Dim>(scene), scene.method.spacing};
}

}  // namespace sluice
