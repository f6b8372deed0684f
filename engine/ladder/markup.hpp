#pragma once

#include <string>
#include <string_view>

namespace sluice {

/// Text as it stands in XML, HTML and SVG, in elements and in quoted attributes.
[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace sluice
