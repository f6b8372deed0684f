#pragma once

#include <cstdint>

namespace sluice {

/// When something periodic in model time happens: at the first step at or after each multiple of
/// `interval` (s), so at step 0 too. An interval of 0 is every step. The schedule depends on model
/// time alone; `next_index` is its whole state and belongs into the checkpoint.
[[nodiscard]] bool is_due(double time, double interval, std::uint64_t next_index);

/// The index to wait for after something happened at `time`: the smallest k with
/// k * interval > time, so that a step across several multiples counts once.
[[nodiscard]] std::uint64_t next_index_after(double time, double interval,
                                             std::uint64_t next_index);

}  // namespace sluice
