#include "cli/json_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

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

std::string size_text(const std::optional<double>& bytes) {
  constexpr double kMebi = 1024.0 * 1024.0;
  return bytes ? fmt::format("{:.1f} MiB", *bytes / kMebi) : "unknown";
}

}  // namespace sluice
