#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.hpp"

namespace sluice {

/// Regions that touch, as indices in the scene's order.
using Body = std::vector<std::size_t>;

/// The regions of a scene by bodies: those whose bounds come within a spacing are in one.
[[nodiscard]] std::vector<Body> bodies(const Scene& scene);

/// Why the lattices of a body's regions do not fit its container, with the place, if they do not:
/// a particle stands nearer to or farther from a wall or an obstacle that it touches than half a
/// spacing; two regions' lattices are out of step; or the particles of regions at a wall hold more
/// than 0.5 % more or less than their area. A body that touches neither wall nor obstacle has
/// nothing to fit.
[[nodiscard]] std::optional<std::string> lattice_misfit(const Scene& scene, const Body& body);

}  // namespace sluice
