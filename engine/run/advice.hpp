#pragma once

#include <string>

#include "engine/sph/method/method.hpp"

namespace sluice {

// What to change in a scene whose run cannot be trusted: only what the scene does not have yet, and
// a smaller Courant number only where it is beyond what its terms allow.

/// Where the scheme has become unstable.
[[nodiscard]] std::string advice_to_steady(const Method& method);
/// Where the flow is too fast or too deep for the sound speed.
[[nodiscard]] std::string advice_to_stiffen(const Method& method);
/// Where particles pass through walls.
[[nodiscard]] std::string advice_to_hold(const Method& method);
/// Where energy comes from nowhere.
[[nodiscard]] std::string advice_to_conserve(const Method& method);

}  // namespace sluice
