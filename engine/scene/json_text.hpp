#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "engine/scene/problems.hpp"

namespace sluice {

/// Reads JSON strictly: at most kMaxSceneBytes and kMaxSceneDepth, both refused while reading, no
/// duplicate keys, no number beyond double. Duplicates are all reported; the first error of syntax
/// ends the reading. Holds no value when nothing can be read on.
[[nodiscard]] std::optional<nlohmann::json> read_json(std::string_view text, Problems& problems);

/// JSON on one line, keys sorted, numbers as shortest() writes them.
[[nodiscard]] std::string write_json(const nlohmann::json& value);

/// What a message calls a value: `a string ("abc...")`, `an array of 3`, `-1`; pure ASCII.
[[nodiscard]] std::string name_value(const nlohmann::json& value);

/// At most 60 characters of JSON in pure ASCII.
[[nodiscard]] std::string excerpt(const nlohmann::json& value);

}  // namespace sluice
