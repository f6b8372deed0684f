#pragma once

#include <cstddef>
#include <vector>

#include "engine/scene/model/shapes.hpp"

namespace sluice {

/// A place on an outline in the plane and the direction out of the shape there.
struct OutlinePoint {
  VecN<2> place = VecN<2>::Zero();  ///< m
  VecN<2> out = VecN<2>::Zero();    ///< of length 1
};

/// Points along an outline in order, equally far apart: about `step`, but at most about `most` of
/// them, and a few on each side of a polygon, also near its corners. None is a corner.
[[nodiscard]] std::vector<OutlinePoint> outline(const ShapeN<2>& shape, double step,
                                                std::size_t most);

}  // namespace sluice
