#include "engine/draw/page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/draw/chart.hpp"
#include "engine/draw/markup.hpp"
#include "sluice/page_texts.hpp"

namespace sluice {
namespace {

/// The text of page.html, page_style.css or chart_style.css.
constexpr std::string_view page_text(std::string_view name) {
  return std::ranges::find(kPageTexts, name, [](const auto& text) { return text.first; })->second;
}

}  // namespace

std::string html_page(std::string_view title, std::string_view body) {
  return fmt::format(page_text("page"), fmt::arg("title", escaped(title)),
                     fmt::arg("style", fmt::format("{}{}", page_text("page_style"), chart_style())),
                     fmt::arg("body", body));
}

std::string_view chart_style() { return page_text("chart_style"); }

}  // namespace sluice
