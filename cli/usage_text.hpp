#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

namespace sluice {

/// The message for a word that should be a verb and is none; empty when there is nothing to object
/// to, as for an option.
[[nodiscard]] std::string unknown_verb(const CLI::App& app, std::string_view word);

/// What is wrong with a command line, in plain words: the option, what was found and what is
/// allowed, and where to read more.
[[nodiscard]] std::string usage_text(const CLI::App& app, const CLI::ParseError& error);

}  // namespace sluice
