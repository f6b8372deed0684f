#pragma once

#include <functional>

#include "engine/store/disk/errors.hpp"

namespace sluice {

/// Whether trying again can help: disk_full, io and unwritable may pass, all else stays.
[[nodiscard]] bool may_pass(StorageFault fault);

/// Does `write`, and after a failure that may pass (see also storing()) again after the waits of
/// Backoff. When `patience` seconds have passed since the first failure it is thrown on; one that
/// no waiting mends is thrown at once. `tell` hears of each failure and of the wait that follows
/// it, s. As soon as `hurried` says so, such as when a stop was asked for, the wait ends, with one
/// more try after it; it may be empty.
void insist(double patience, const std::function<void()>& write,
            const std::function<void(const StorageError&, double)>& tell,
            const std::function<bool()>& hurried = {});

}  // namespace sluice
