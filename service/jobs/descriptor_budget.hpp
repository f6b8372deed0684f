#pragma once

#include <cstdint>

namespace sluice {

/// Raises this process's limit of open files (`ulimit -n`) as far as the system lets it, and
/// returns it.
std::uint64_t raise_descriptor_limit();

/// How many connections a service may have at once under such a limit, so that its files and
/// `workers` workers have theirs; below 1 where it cannot serve.
[[nodiscard]] int connections_within(std::uint64_t limit, int workers);

/// The limit that a service with so many workers needs for a few connections.
[[nodiscard]] std::uint64_t least_descriptor_limit(int workers);

}  // namespace sluice
