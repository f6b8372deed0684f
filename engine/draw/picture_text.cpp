#include "engine/draw/picture_text.hpp"

#include <algorithm>
#include <array>

namespace sluice {
namespace {

constexpr int kDot = 2;      ///< pixels of a letter's dot
constexpr int kAdvance = 6;  ///< dots from one letter to the next

/// Seven rows of five dots, the leftmost in bit 4.
struct Letter {
  char character;
  std::array<unsigned char, 7> rows;
};

constexpr std::array kLetters{
    Letter{'0', {14, 17, 19, 21, 25, 17, 14}}, Letter{'1', {4, 12, 4, 4, 4, 4, 14}},
    Letter{'2', {14, 17, 1, 2, 4, 8, 31}},     Letter{'3', {31, 2, 4, 2, 1, 17, 14}},
    Letter{'4', {2, 6, 10, 18, 31, 2, 2}},     Letter{'5', {31, 16, 30, 1, 1, 17, 14}},
    Letter{'6', {6, 8, 16, 30, 17, 17, 14}},   Letter{'7', {31, 1, 2, 4, 8, 8, 8}},
    Letter{'8', {14, 17, 17, 14, 17, 17, 14}}, Letter{'9', {14, 17, 17, 15, 1, 2, 12}},
    Letter{'.', {0, 0, 0, 0, 0, 12, 12}},      Letter{'-', {0, 0, 0, 31, 0, 0, 0}},
    Letter{'+', {0, 4, 4, 31, 4, 4, 0}},       Letter{'=', {0, 0, 31, 0, 31, 0, 0}},
    Letter{'/', {1, 1, 2, 4, 8, 16, 16}},      Letter{'t', {8, 8, 28, 8, 8, 9, 6}},
    Letter{'s', {0, 0, 15, 16, 14, 1, 30}},    Letter{'T', {31, 4, 4, 4, 4, 4, 4}},
    Letter{'P', {30, 17, 17, 30, 16, 16, 16}}, Letter{'a', {0, 0, 14, 1, 15, 17, 15}},
    Letter{'k', {16, 16, 18, 20, 24, 20, 18}}, Letter{'M', {17, 27, 21, 21, 17, 17, 17}},
    Letter{'m', {0, 0, 26, 21, 21, 17, 17}},   Letter{'p', {0, 0, 30, 17, 30, 16, 16}},
    Letter{'e', {0, 0, 14, 17, 31, 16, 14}},   Letter{'v', {0, 0, 17, 17, 17, 10, 4}},
};

void draw_dot(Picture& picture, int column, int row) {
  for (int j = std::max(0, row); j < std::min(picture.height, row + kDot); ++j) {
    for (int i = std::max(0, column); i < std::min(picture.width, column + kDot); ++i) {
      picture.pixels[static_cast<std::size_t>(j) * static_cast<std::size_t>(picture.width) +
                     static_cast<std::size_t>(i)] = kInk;
    }
  }
}

}  // namespace

void draw_text(Picture& picture, int column, int row, std::string_view text) {
  for (const char character : text) {
    const auto* const letter =
        std::find_if(kLetters.begin(), kLetters.end(),
                     [&](const Letter& one) { return one.character == character; });
    if (letter != kLetters.end()) {
      for (int j = 0; j < 7; ++j) {
        for (int i = 0; i < 5; ++i) {
          const bool set = (letter->rows[static_cast<std::size_t>(j)] >> (4 - i) & 1) != 0;
          if (set) draw_dot(picture, column + i * kDot, row + j * kDot);
        }
      }
    }
    column += kAdvance * kDot;
  }
}

int text_width(std::string_view text) { return static_cast<int>(text.size()) * kAdvance * kDot; }

}  // namespace sluice
