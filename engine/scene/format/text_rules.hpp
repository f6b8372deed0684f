#pragma once

#include <string_view>

#include "engine/scene/model/spec.hpp"

namespace sluice {

/// Whether a text has only the characters that a key allows, in their order.
[[nodiscard]] bool are_allowed(std::string_view text, Characters characters);

/// The same for people, after "a text of 1 to 64 characters, ".
[[nodiscard]] std::string_view allowed_text(Characters characters);

/// The same as a regular expression, for the schema.
[[nodiscard]] std::string_view allowed_pattern(Characters characters);

}  // namespace sluice
