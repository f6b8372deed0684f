#pragma once

#include <functional>

#include "engine/store/errors.hpp"

namespace sluice {

/// Does `write`, and after a failure that may pass (disk_full, io, unwritable; see storing()) again
/// after the waits of Backoff. When `patience` seconds have passed since the first failure it is
/// thrown on; one that no waiting mends is thrown at once. `tell` hears of each failure and of the
/// wait that follows it, s.
void insist(double patience, const std::function<void()>& write,
            const std::function<void(const StorageError&, double)>& tell);

}  // namespace sluice
