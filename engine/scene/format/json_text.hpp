#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "engine/scene/model/problems.hpp"

namespace sluice {

// Bounds of every JSON text that is read, whoever wrote it: what it takes of memory, stack and time
// is a small multiple of its bytes. Its depth is at most kMaxSceneDepth.
inline constexpr std::size_t kMaxKeys = 2048;     ///< of one object
inline constexpr std::size_t kMaxKeyBytes = 256;  ///< of one key
inline constexpr std::size_t kMaxStoredBytes = std::size_t{2} << 20;

/// Reads JSON strictly: at most kMaxSceneBytes and within the bounds above, all refused while
/// reading, no duplicate keys, no number beyond double. Duplicates are all reported; the first
/// error of syntax ends the reading. Holds no value when nothing can be read on.
[[nodiscard]] std::optional<nlohmann::json> read_json(std::string_view text, Problems& problems);

/// Reads what a program wrote, such as a file in a job's folder, a column of a row or a line of a
/// worker: as strictly, at most kMaxStoredBytes, keys in their order. Throws std::runtime_error.
[[nodiscard]] nlohmann::ordered_json read_stored_json(std::string_view text);

/// JSON on one line, keys sorted, numbers as shortest() writes them.
[[nodiscard]] std::string write_json(const nlohmann::json& value);

/// What a message calls a value: `a string ("abc...")`, `an array of 3`, `-1`; pure ASCII.
[[nodiscard]] std::string name_value(const nlohmann::json& value);

/// At most 60 characters of JSON in pure ASCII.
[[nodiscard]] std::string excerpt(const nlohmann::json& value);

}  // namespace sluice
