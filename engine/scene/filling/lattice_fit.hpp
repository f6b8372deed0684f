#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/scene/filling/bodies.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

/// Why the lattices of a body's regions do not fit its container, with the place, if they do not:
/// a particle stands nearer to or farther from a wall or an obstacle that it touches than half a
/// spacing; the dummy particles behind that face do not go on with the lattice, as a rectangle's
/// cells are more than 0.5 % off dx or a polygon's face is not on the origin's lattice; two
/// regions' lattices are out of step; or the particles of regions at a wall hold more than 0.5 %
/// more or less than their area. A body that touches neither wall nor obstacle has nothing to fit.
[[nodiscard]] std::optional<std::string> lattice_misfit(const Scene& scene, const Body& body);

/// Which obstacles of a plane scene a body that does not fit touches at the start: particles of its
/// regions' lattices lie within one and a half spacings of them.
[[nodiscard]] std::vector<bool> beside_misfits(const Scene& scene);

}  // namespace sluice
