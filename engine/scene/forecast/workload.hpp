#pragma once

#include "engine/scene/model/scene.hpp"

namespace sluice {

// How much a scene asks for, in double so that absurd scenes give large numbers and not overflow.
// Any scene whose keys are in their ranges may be asked.

/// Fluid particles: exact for rectangles, else area over dx^2; obstacles take none away.
[[nodiscard]] double count_fluid_cells(const Scene& scene);

/// Dummy particles: exact for the tank, area or outline times layers for obstacles.
[[nodiscard]] double count_wall_cells(const Scene& scene);

/// Cells that are looked at to make the dummy particles of the obstacles.
[[nodiscard]] double count_obstacle_cells(const Scene& scene);

/// eq. 18 with the speed of the fastest region or of a fall through the fluid's height, and the
/// body acceleration, s. Impacts make shorter steps.
[[nodiscard]] double expected_time_step(const Scene& scene);

/// 0.25 sqrt(h/|f|), s: what the force limit leaves fluid that falls freely; infinite without
/// gravity.
[[nodiscard]] double force_time_step(const Method& method);

/// Samples of all sensors until the end time; one every step where the interval is shorter.
[[nodiscard]] double count_samples(const Scene& scene);
[[nodiscard]] double count_frames(const Scene& scene);

}  // namespace sluice
