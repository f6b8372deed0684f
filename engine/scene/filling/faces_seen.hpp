#pragma once

#include <string_view>
#include <vector>

#include "engine/scene/geometry/tank_room.hpp"
#include "engine/scene/model/shapes.hpp"

namespace sluice {

// In spacings, and of an area: what is off by less fits.
inline constexpr double kOffLattice = 0.02;
inline constexpr double kOffArea = 0.005;

/// A face of a solid that a point sees straight in front of it.
struct SeenFace {
  double distance;      ///< spacings
  bool along_lattice;   ///< the face stands across an axis
  bool backed = true;   ///< dummy particles stand dx/2 behind it and dx apart
  std::string_view of;  ///< for messages
};

/// The faces of an obstacle or the gate that a point is straight beside; of one beside a corner
/// or an edge none.
[[nodiscard]] std::vector<SeenFace> faces_seen(const ShapeN<2>& solid, const VecN<2>& point,
                                               double spacing);
[[nodiscard]] std::vector<SeenFace> faces_seen(const ShapeN<3>& solid, const VecN<3>& point,
                                               double spacing);

/// The faces of a tank, seen by a point in it.
template <int Dim>
[[nodiscard]] std::vector<SeenFace> faces_seen(const TankRoomN<Dim>& tank, const VecN<Dim>& point,
                                               double spacing);

}  // namespace sluice
