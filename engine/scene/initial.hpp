#pragma once

#include <optional>
#include <vector>

#include "engine/scene/parse.hpp"
#include "engine/scene/scene.hpp"
#include "engine/sph/particles.hpp"

namespace sluice {

/// What a run starts from.
struct InitialParticles {
  SolverState state;       ///< only x, y, vx, vy, density_excess and id are filled
  std::vector<Vec> walls;  ///< dummy particles of the tank, then of the obstacles, m
};

/// Fills the scene with particles, each of mass rho_0 dx^2.
///
/// Fluid lies at the cell centres of a lattice of spacing dx that starts at the lower left corner
/// of a rectangle, and at the origin for every other shape. Particles inside an obstacle or nearer
/// than dx/2 to it are left out: an obstacle displaces fluid. Regions come in the scene's order,
/// rows from the bottom up, each from left to right; `id` counts 0, 1, ... in that order.
///
/// density_excess = p/c^2 (eq. 3), with p = rho_0 f.(x - x_top) below the region's highest point
/// against gravity f, or p = 0. A region knows nothing of the weight of another on top of it.
///
/// Throws SceneError when two regions put particles closer than dx/2 in both directions to each
/// other, or when no fluid is left.
[[nodiscard]] InitialParticles create_particles(const Scene& scene);

/// What create_particles would throw: regions that overlap, or a scene without fluid, show only
/// when it is filled. Takes as long as filling it.
[[nodiscard]] std::optional<Problem> problem_when_filled(const Scene& scene);

}  // namespace sluice
