#pragma once

#include <string>
#include <string_view>

namespace sluice {

/// Text as it stands in XML, HTML and SVG, in elements and in quoted attributes.
[[nodiscard]] std::string escaped(std::string_view text);

/// UTF-8 with each character as '?' that a terminal obeys rather than shows: controls, and what
/// turns the direction of a line.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace sluice
