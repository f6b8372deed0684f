#pragma once

#include <cstdint>

namespace sluice {

/// Shortest slice that Linux gives, ns.
inline constexpr std::uint64_t kShortestSlice = 100'000;

/// Asks for slices of so many nanoseconds for the calling thread and those that it starts from now
/// on; 0: the system's default. What wakes with a short slice does not wait until those with longer
/// ones have used up theirs; its share of the cores stays the same. From Linux 6.12 on, without
/// effect before. Async-signal-safe.
void ask_for_slices(std::uint64_t nanoseconds);

}  // namespace sluice
