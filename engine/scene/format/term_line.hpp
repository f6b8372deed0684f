#pragma once

#include <fmt/args.h>
#include <fmt/format.h>

#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "engine/sph/terms/parameter.hpp"

namespace sluice {

/// A line that a term has for its reader, each {key} replaced by the value of that parameter.
template <class Term>
[[nodiscard]] std::string filled_in(std::string_view line, const Term& term) {
  fmt::dynamic_format_arg_store<fmt::format_context> values;
  const auto add = [&](const auto& parameter) {
    const auto& value = term.*parameter.member;
    const std::string key(parameter.key);
    if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(value)>>) {
      values.push_back(fmt::arg(key.c_str(), word_for(parameter.words, value)));
    } else {
      values.push_back(fmt::arg(key.c_str(), value));
    }
  };
  std::apply([&](const auto&... each) { (add(each), ...); }, Term::kParameters);
  return fmt::vformat(line, values);
}

}  // namespace sluice
