#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "engine/draw/markup.hpp"

namespace sluice {

// Reading what a server sent: nothing here trusts its form, and no text of it moves a terminal's
// cursor.

/// The member, or null when there is none or `object` is none.
[[nodiscard]] const nlohmann::ordered_json& member(const nlohmann::ordered_json& object,
                                                   std::string_view key);
/// The member's text, printable; empty when it is no text.
[[nodiscard]] std::string text_at(const nlohmann::ordered_json& object, std::string_view key);
[[nodiscard]] std::optional<double> number_at(const nlohmann::ordered_json& object,
                                              std::string_view key);
/// The member as a whole number in full; "?" when it is none.
[[nodiscard]] std::string count_at(const nlohmann::ordered_json& object, std::string_view key);

/// A size as "12.3 MiB"; "unknown" without one.
[[nodiscard]] std::string size_text(const std::optional<double>& bytes);

}  // namespace sluice
