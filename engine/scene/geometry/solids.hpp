#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// All that is solid in a scene but a gate: the obstacles and, around the tank, the rest of the
/// world but the air above an open top.
class Solids {
 public:
  explicit Solids(const Scene& scene);

  [[nodiscard]] bool holds(const Vec& point) const;
  /// Whether a point is in the open and at least this far from all that is solid, m.
  [[nodiscard]] bool leaves_room(const Vec& point, double margin) const;
  /// How far a point is from the open, m: 0 in the open, also where one solid lies against another;
  /// there it is sought up to `most` in steps of `most`/32, and all that is deeper counts as that.
  [[nodiscard]] double depth(const Vec& point, double most) const;
  /// The same of the walls around the tank alone.
  [[nodiscard]] double depth_in_walls(const Vec& point) const;
  /// How far one gets from a point in the open or in a solid before that changes, m; nothing when
  /// it is `most` or more. `step` is the length that nothing shorter than is found.
  [[nodiscard]] std::optional<double> reach(const Vec& from, const Vec& direction, double most,
                                            double step) const;

 private:
  struct Body {
    const Shape* shape;
    Box box;
  };

  std::vector<Body> bodies_;
  std::optional<Tank> tank_;
  double slack_;  ///< m; gaps of rounding are none
};

/// A place on an outline and the direction out of the shape there.
struct OutlinePoint {
  Vec place = Vec::Zero();
  Vec out = Vec::Zero();
};

/// Points along an outline in order, equally far apart: about `step`, but at most about `most` of
/// them, and a few on each side of a polygon, also near its corners. None is a corner.
[[nodiscard]] std::vector<OutlinePoint> outline(const Shape& shape, double step, std::size_t most);

}  // namespace sluice
