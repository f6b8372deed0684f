#pragma once

#include <string_view>

#include "engine/sph/method/method.hpp"

namespace sluice {

/// Fluid particles times steps that one core of this machine does in a second of processor time
/// with this method, sorting and sampling as in a dam break included. Measured on a small tank in
/// some 30 ms when a method of this cost is asked for first, and kept. Thread-safe.
/// `simd` is the target, empty for this machine's best.
[[nodiscard]] double particle_steps_per_core_second(const Method& method,
                                                    std::string_view simd = "");

}  // namespace sluice
