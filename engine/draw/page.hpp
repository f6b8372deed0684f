#pragma once

#include <string>
#include <string_view>

namespace sluice {

/// An HTML page in the one style of all pages, light and dark, that charts may stand in. It has no
/// script and loads nothing. `title` is text, `body` is HTML.
[[nodiscard]] std::string html_page(std::string_view title, std::string_view body);

}  // namespace sluice
