#include "engine/draw/markup.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace sluice {
namespace {

/// What a terminal obeys rather than shows: U+0080 to U+009F, and what turns the direction of a
/// line, breaks it or takes no room (U+061C, U+200B to U+200F, U+2028 to U+202E, U+2060 to U+206F,
/// U+FEFF, the tags U+E0000 to U+E007F).
bool is_hidden(unsigned code) {
  const auto within = [code](unsigned first, unsigned last) {
    return code >= first && code <= last;
  };
  return within(0x80, 0x9F) || code == 0x61C || within(0x200B, 0x200F) || within(0x2028, 0x202E) ||
         within(0x2060, 0x206F) || code == 0xFEFF || within(0xE0000, 0xE007F);
}

/// Bytes of a character at the beginning of `text` that is not shown; 0 when it is.
std::size_t hidden_character(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  if (first < 0x20 || first == 0x7F) return 1;
  // As many ones as the first byte begins with, so many bytes the character has.
  const auto bytes = static_cast<std::size_t>(std::countl_one(first));
  if (bytes < 2 || bytes > 4 || text.size() < bytes) return 0;
  unsigned code = first & (0x7FU >> bytes);
  for (std::size_t n = 1; n < bytes; ++n) {
    code = code << 6U | (static_cast<unsigned char>(text[n]) & 0x3FU);
  }
  return is_hidden(code) ? bytes : 0;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += letter;
    }
  }
  return result;
}

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t hidden = hidden_character(text);
    result += hidden > 0 ? '?' : text.front();
    text.remove_prefix(std::max<std::size_t>(hidden, 1));
  }
  return result;
}

}  // namespace sluice
