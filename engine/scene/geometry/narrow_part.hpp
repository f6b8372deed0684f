#pragma once

#include <optional>
#include <vector>

#include "engine/scene/geometry/outline.hpp"
#include "engine/scene/geometry/solids.hpp"

namespace sluice {

/// A part of an outline in the plane across which something is narrow.
struct Narrow {
  double width = 0.0;  ///< m
  VecN<2> place = VecN<2>::Zero();
};

enum class Across {
  solid,  ///< from the open through the body and into the open again
  gap,    ///< from the body through the open to what is solid again: a slit
};

/// The narrowest part that is narrower than `most`, m. What tapers to nothing is none: the corner
/// of a body, or the gap under a circle on a floor. A slit is one through which one can see for
/// two spacings both ways, so the corner between a floor and what leans over it is none.
[[nodiscard]] std::optional<Narrow> narrow_part(const SolidsN<2>& solids,
                                                const std::vector<OutlinePoint>& outline,
                                                Across across, double most, double spacing);

}  // namespace sluice
