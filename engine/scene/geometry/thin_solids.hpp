#pragma once

#include <optional>
#include <vector>

#include "engine/scene/geometry/narrow_part.hpp"
#include "engine/scene/geometry/too_thin.hpp"

namespace sluice {

/// The thinnest part near an outline in the plane that would let fluid through, for particles
/// `spacing` apart.
///
/// Fluid is where its particles have room, half a spacing from all solids. Two such places lie on
/// two sides of a solid that is too thin when they are less than a spacing plus two of thickness
/// apart, with solids between them, and the way from one to the other where particles have room is
/// long: more than two spacings and seven times the thickness. So a corner or a tip of 17 degrees
/// or more is none, for fluid flows round it, and neither is what lies on a floor, at a wall or at
/// another solid; a tip that touches the floor is one, and so are two blocks that touch with their
/// corners. A body in which no disc of two spacings has room is too thin as well.
///
/// The place is in the middle of the solid; the width is less than two spacings, and below zero
/// where particles on both sides come nearer to one another than in the open.
[[nodiscard]] std::optional<Narrow> thin_part(const SolidsN<2>& solids,
                                              const std::vector<OutlinePoint>& outline,
                                              double spacing);

}  // namespace sluice
