#pragma once

#include <string>
#include <string_view>

#include "engine/store/files/checkpoint.hpp"

namespace sluice {

/// SHA-256 in hexadecimal over all that decides how a run goes on: step, time, every field in
/// particle order, removed particles, series, guard baselines, next frame. Not in it: scene hash,
/// build, SIMD target and `bit_exact`. Changes with any bit of any of these.
[[nodiscard]] std::string physics_digest(const Checkpoint& checkpoint);

/// The same for one series, names and units of its columns included.
[[nodiscard]] std::string series_digest(const Series& series);

/// XXH3-128 in hexadecimal of the text that identifies a scene: what checkpoints are bound to.
[[nodiscard]] std::string scene_hash(std::string_view identity_text);

}  // namespace sluice
