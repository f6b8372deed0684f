#pragma once

#include <vector>

#include "engine/store/disk/errors.hpp"
#include "engine/store/files/checkpoint.hpp"

namespace sluice {

// The rules that content must keep beyond its layout, the same before writing and after reading.
// Each throws StorageError with `fault` and names the field, the index and the value.

/// Carried fields have one finite value per particle, the others none; all numbers are finite; the
/// samples keep their rules.
void require_sound(const Checkpoint& checkpoint, StorageFault fault);

/// Times are finite and strictly increasing; every sample has a duration, and for each sensor a
/// weight and one value per column; a value that is not finite is NaN with weight 0. Every place in
/// the scene's list is taken once.
void require_sound(const std::vector<SampleTable>& tables, StorageFault fault);

}  // namespace sluice
