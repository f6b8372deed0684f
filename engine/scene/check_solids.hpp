#pragma once

#include "engine/scene/problems.hpp"
#include "engine/scene/scene.hpp"

namespace sluice {

/// A solid that is thinner lets fluid through, in spacings. Measured with both schemes at 15 to 60
/// particles of water in front of a plate, at rest and at an impact, upright and at angles from 15
/// to 45 degrees: of 1500 particles up to 227 were behind one of 1.75 spacings, none behind any of
/// 2, 2.25, 2.5, 3 or 4. A plate of two spacings holds two layers of dummy particles whatever its
/// angle, and no pair across it is nearer than the two.
inline constexpr double kThinnestSolid = 2.0;
/// Through a gap that is narrower no row of particles passes freely, in spacings.
inline constexpr double kNarrowestSlit = 2.0;
/// Pressures on a body with fewer particles across are uncertain: at 9, tensions of seven times
/// rho g h0 were met on one.
inline constexpr double kFewAcross = 10.0;

/// Obstacles that fluid would pass through are problems; slits and few particles across are
/// warnings. `scene` is resolved. Takes some milliseconds at most, whatever the spacing.
void check_solids(const Scene& scene, Problems& problems, Problems& warnings);

/// Warns of sensors where no fluid can ever be. One on a wall or up to half a spacing in it is on
/// its face. `scene` is resolved.
void check_sensor_places(const Scene& scene, Problems& warnings);

}  // namespace sluice
