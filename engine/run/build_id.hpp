#pragma once

#include <string>

namespace sluice {

/// The version and, where the linker left one, the first half of the GNU build id of this program:
/// equal for the same binary only. A checkpoint carries it, because the promise of equal bits holds
/// for one binary.
[[nodiscard]] const std::string& build_id();

}  // namespace sluice
