#pragma once

#include "engine/scene/model/problems.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

/// In a gap that is narrower fewer than two particles lie side by side, in spacings. Some pass all
/// the same: of 870 in front of a slit of one spacing 187 did in 1.5 s, of one of 1.9 spacings 331.
inline constexpr double kNarrowestSlit = 2.0;
/// Pressures on a body with fewer particles across are uncertain: at 9, tensions of seven times
/// rho g h0 were met on one.
inline constexpr double kFewAcross = 10.0;

/// Obstacles that fluid would pass through are problems; slits and few particles across are
/// warnings. `scene` is resolved. Takes some milliseconds in the plane and about a second
/// in space at most, whatever the spacing.
void check_solids(const Scene& scene, Problems& problems, Problems& warnings);

/// Warns of sensors where no fluid can ever be. One on a wall or up to half a spacing in it is on
/// its face. `scene` is resolved.
void check_sensor_places(const Scene& scene, Problems& warnings);

}  // namespace sluice
