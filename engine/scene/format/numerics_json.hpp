#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "engine/sph/method/method.hpp"

namespace sluice {

/// Every key of `numerics` but `scheme` with its value: null for a term that is left out.
[[nodiscard]] nlohmann::json numerics_json(const Method& method);

/// Whether null is a value of the scene's key with this JSON pointer: a term that is left out.
[[nodiscard]] bool takes_null(std::string_view pointer);

}  // namespace sluice
