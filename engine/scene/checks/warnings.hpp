#pragma once

#include "engine/scene/model/problems.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

/// Warns of a Courant number beyond what the analysis calls stable or an impact leaves of it, and
/// of a scheme that damps nothing.
/// `scene` is resolved and not refused as unstable.
void warn_of_growth(const Scene& scene, Problems& warnings);

/// Warns of a sound speed below five times the speed that the fluid begins with or falls to: the
/// density of a weakly compressible fluid changes by the square of their ratio.
void warn_of_slow_sound(const Scene& scene, Problems& warnings);

/// Warns of sample intervals that are shorter than a time step: every step is sampled then.
void warn_of_short_intervals(const Scene& scene, Problems& warnings);

}  // namespace sluice
