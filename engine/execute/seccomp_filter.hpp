#pragma once

#include <linux/filter.h>

#include <cstddef>
#include <vector>

namespace sluice {

/// A seccomp program and the instructions whose constant is the process's own id, to be filled in
/// by that process.
struct SeccompFilter {
  std::vector<sock_filter> program;  ///< empty on an architecture that it is not written for
  std::vector<std::size_t> own_id;
};

/// Refuses with EPERM what a run never does: sockets, tracing, signals to others, mounts,
/// namespaces, io_uring, kernel keys, other limits, and every exec but the one of `descriptor`
/// itself.
[[nodiscard]] SeccompFilter confined_filter(int descriptor);

}  // namespace sluice
