#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/filling/packing.hpp"
#include "engine/scene/model/problems.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/sph/method/particles.hpp"

namespace sluice {

/// What a run starts from.
struct InitialParticles {
  SolverState state;                     ///< only positions, velocities, density_excess and id
  std::vector<Vec> walls;                ///< dummy particles of the tank, then of the obstacles, m
  std::optional<PackingReport> packing;  ///< absent where all fluid lies on its lattice
};

/// Fills the scene with particles, each of mass rho_0 dx^2.
///
/// Fluid lies at the cell centres of a lattice of spacing dx that starts at the lower left corner
/// of a rectangle, and at the origin for every other shape. Particles inside an obstacle or nearer
/// than dx/2 to it are left out: an obstacle displaces fluid. Regions come in the scene's order,
/// rows from the bottom up, each from left to right; `id` counts 0, 1, ... in that order.
///
/// Where that lattice does not fit the container (lattice_misfit), each region of the body gets
/// round(area/dx^2) particles instead, column by column, and they are packed: see pack().
///
/// density_excess = p/c^2 (eq. 3) with the pressure of WaterLevels, or p = 0.
///
/// Throws SceneError when two regions put particles closer than dx/2 in both directions to each
/// other, or when no fluid is left.
[[nodiscard]] InitialParticles create_particles(const Scene& scene);

/// How a run will start; `fluid_particles` is exactly what create_particles makes.
struct StartPlan {
  bool packed = false;
  std::string reason;  ///< why it is packed, with the place; "" where it is not
  std::size_t fluid_particles = 0;
};

/// Fills the lattice to know, and packs nothing. Throws as create_particles does.
[[nodiscard]] StartPlan start_plan(const Scene& scene);

/// What create_particles would throw: regions that overlap, or a scene without fluid, show only
/// when it is filled. Takes as long as filling a lattice.
[[nodiscard]] std::optional<Problem> problem_when_filled(const Scene& scene);

}  // namespace sluice
