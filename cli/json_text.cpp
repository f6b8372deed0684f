#include "cli/json_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

bool is_control(unsigned char c) { return c < 0x20 || c == 0x7F; }

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
  for (std::size_t n = 0; n < text.size(); ++n) {
    // C2 80 to C2 9F are the control characters U+0080 to U+009F.
    const bool second_set =
        text[n] == '\xC2' && n + 1 < text.size() && static_cast<unsigned char>(text[n + 1]) < 0xA0;
    if (second_set) ++n;
    result += second_set || is_control(static_cast<unsigned char>(text[n])) ? '?' : text[n];
  }
  return result;
}

std::string size_text(const std::optional<double>& bytes) {
  constexpr double kMebi = 1024.0 * 1024.0;
  return bytes ? fmt::format("{:.1f} MiB", *bytes / kMebi) : "unknown";
}

}  // namespace sluice
