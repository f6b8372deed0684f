#pragma once

#include "engine/scene/document.hpp"
#include "engine/scene/problems.hpp"

namespace sluice {

/// What relates keys to one another: shapes to the tank, the domain and the spacing; the sound
/// speed to gravity; sensors to the domain; the amount of work to the limits; the Courant number to
/// what linear analysis calls stable. Each check leaves out
/// what has problems already. Allocates nothing in proportion to what the scene asks for.
void check(const Document& document, StabilityCheck stability, Problems& problems);

}  // namespace sluice
