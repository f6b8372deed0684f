#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace sluice {

/// The manual page of the program, sluice(1), in the macros of man(7): made from the verbs and
/// options as they are.
[[nodiscard]] std::string man_page(const CLI::App& app);

}  // namespace sluice
