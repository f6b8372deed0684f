#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/scene/filling/initial.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

/// What a run of a scene takes, found from areas and lengths unless the particles are given.
struct Estimate {
  std::uint64_t fluid_particles = 0;  ///< exact for rectangles without obstacles
  std::uint64_t wall_particles = 0;   ///< exact without obstacles
  double time_step = 0.0;             ///< s, eq. 18 at the speed sqrt(2 |f| H) of a fall through H
  std::uint64_t steps = 0;            ///< end_time / time_step
  std::uint64_t samples = 0;          ///< of all sensors together
  std::uint64_t frames = 0;           ///< snapshots
  std::uint64_t memory_bytes = 0;     ///< the most at once, the program's own 28 MB included
  std::uint64_t disk_bytes = 0;       ///< three checkpoints, the series and the frames
};

[[nodiscard]] Estimate estimate(const Scene& scene);

/// The same with the particles counted as they will be made: takes as long as filling the scene,
/// and throws SceneError for what shows only then, such as regions that overlap.
[[nodiscard]] Estimate exact_estimate(const Scene& scene);

/// Processor time that the run takes on this machine, s: what `plan` and the service go by. The
/// machine is measured when it is asked for the first time (machine_speed.hpp).
[[nodiscard]] double expected_core_seconds(const Scene& scene, const Estimate& estimate,
                                           std::string_view simd = "");

/// The same as a JSON object, keys as the members.
[[nodiscard]] std::string estimate_json(const Estimate& estimate);

}  // namespace sluice
