#include "cli/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// What a terminal obeys rather than shows: U+0080 to U+009F, and what turns the direction of a
/// line, breaks it or takes no room (U+061C, U+200B to U+200F, U+2028 to U+202E, U+2060 to U+206F,
/// U+FEFF).
bool is_hidden(unsigned code) {
  const auto within = [code](unsigned first, unsigned last) {
    return code >= first && code <= last;
  };
  return within(0x80, 0x9F) || code == 0x61C || within(0x200B, 0x200F) || within(0x2028, 0x202E) ||
         within(0x2060, 0x206F) || code == 0xFEFF;
}

/// Bytes of a character at the beginning of `text` that is not shown; 0 when it is.
std::size_t hidden_character(std::string_view text) {
  const auto at = [&](std::size_t n) { return static_cast<unsigned char>(text[n]); };
  if (at(0) < 0x20 || at(0) == 0x7F) return 1;
  if ((at(0) & 0xE0U) == 0xC0 && text.size() > 1) {
    return is_hidden((at(0) & 0x1FU) << 6U | (at(1) & 0x3FU)) ? 2 : 0;
  }
  if ((at(0) & 0xF0U) == 0xE0 && text.size() > 2) {
    return is_hidden((at(0) & 0x0FU) << 12U | (at(1) & 0x3FU) << 6U | (at(2) & 0x3FU)) ? 3 : 0;
  }
  return 0;
}

}  // namespace

const Json& member(const Json& object, std::string_view key) {
  static const Json none;
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

std::string text_at(const Json& object, std::string_view key) {
  const Json& value = member(object, key);
  return value.is_string() ? printable(value.get_ref<const std::string&>()) : "";
}

std::optional<double> number_at(const Json& object, std::string_view key) {
  const Json& value = member(object, key);
  if (!value.is_number()) return {};
  const auto number = value.get<double>();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::string count_at(const Json& object, std::string_view key) {
  const Json& value = member(object, key);
  return value.is_number_integer() ? value.dump() : "?";
}

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t hidden = hidden_character(text);
    result += hidden > 0 ? '?' : text.front();
    text.remove_prefix(std::max<std::size_t>(hidden, 1));
  }
  return result;
}

std::string size_text(const std::optional<double>& bytes) {
  constexpr double kMebi = 1024.0 * 1024.0;
  return bytes ? fmt::format("{:.1f} MiB", *bytes / kMebi) : "unknown";
}

}  // namespace sluice
