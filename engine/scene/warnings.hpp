#pragma once

#include "engine/scene/problems.hpp"
#include "engine/scene/scene.hpp"

namespace sluice {

/// Warns of a Courant number beyond what the analysis calls stable or an impact leaves of it.
/// `scene` is resolved and not refused as unstable.
void warn_of_growth(const Scene& scene, Problems& warnings);

/// Warns of sample intervals that are shorter than a time step: every step is sampled then.
void warn_of_short_intervals(const Scene& scene, Problems& warnings);

}  // namespace sluice
