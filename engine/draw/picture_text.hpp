#pragma once

#include <string_view>

#include "engine/draw/picture.hpp"

namespace sluice {

/// Height of a line of letters, pixels.
inline constexpr int kLetterHeight = 14;

/// Draws digits, . - + = and the letters of times and units with their upper left corner at a
/// pixel; any other character is a gap. What lies outside the picture is cut.
void draw_text(Picture& picture, int column, int row, std::string_view text);

/// Its width, pixels.
[[nodiscard]] int text_width(std::string_view text);

}  // namespace sluice
